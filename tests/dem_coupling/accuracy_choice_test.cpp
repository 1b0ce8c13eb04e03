// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/accuracy_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace him {
namespace {

FieldSettings p3mOf(const P3mSettings& p3m)
{
    FieldSettings settings;
    settings.method = "p3m";
    settings.p3m = p3m;
    return settings;
}

TEST(AccuracyChoice, takesTheCheapestCloudsThatAreGoodEnough)
{
    EXPECT_EQ(chooseForAccuracy(0.5).p3m.cloudCells, 2);
    EXPECT_EQ(chooseForAccuracy(0.055).p3m.cloudCells, 2);
    EXPECT_EQ(chooseForAccuracy(0.054).p3m.cloudCells, 3);
    EXPECT_EQ(chooseForAccuracy(0.01).p3m.cloudCells, 4);
    EXPECT_EQ(chooseForAccuracy(0.003).p3m.cloudCells, 6);
}

TEST(AccuracyChoice, takesTheBetterGatherAndTheCorrectionWithLargeClouds)
{
    EXPECT_EQ(chooseForAccuracy(0.1).p3m.gather, PolynomialOrder::cubic);
    EXPECT_FALSE(chooseForAccuracy(0.1).p3m.deferredCorrection);
    EXPECT_EQ(chooseForAccuracy(0.02).p3m.gather, PolynomialOrder::quartic);
    EXPECT_TRUE(chooseForAccuracy(0.02).p3m.deferredCorrection);
}

TEST(AccuracyChoice, expectsNoMoreThanWasAskedFor)
{
    for (double accuracy = 1; accuracy >= smallestAccuracy(); accuracy *= 0.9) {
        const AccuracyChoice choice = chooseForAccuracy(accuracy);
        EXPECT_LE(choice.expected, accuracy);
        EXPECT_EQ(expectedError(p3mOf(choice.p3m)), choice.expected);
    }
}

TEST(AccuracyChoice, takesLargerCloudsWhereCellsAreSmallerThanParticles)
{
    EXPECT_EQ(chooseForAccuracy(0.055, 0.5).p3m.cloudCells, 2);
    EXPECT_EQ(chooseForAccuracy(0.055, 2).p3m.cloudCells, 3);
    EXPECT_EQ(chooseForAccuracy(0.012, 2).p3m.cloudCells, 4);
    EXPECT_THROW(chooseForAccuracy(0.0012, 1.01), std::invalid_argument);
    FieldSettings settings = p3mOf(chooseForAccuracy(0.055, 2).p3m);
    settings.cellsPerDiameter = 2;
    EXPECT_EQ(expectedError(settings), chooseForAccuracy(0.055, 2).expected);
    // Measured in half a diameter: .106 at two cells, in the table twice .055.
    settings.p3m.cloudCells = 2;
    EXPECT_GE(expectedError(settings), 0.106);
}

TEST(AccuracyChoice, sumsPairsInSinglePrecisionWhichIsFarBelowEveryError)
{
    EXPECT_EQ(chooseForAccuracy(smallestAccuracy()).p3m.nearPrecision, NearPrecision::singlePrecision);
}

TEST(AccuracyChoice, refusesWhatNoSettingReaches)
{
    EXPECT_NO_THROW(chooseForAccuracy(smallestAccuracy()));
    EXPECT_THROW(chooseForAccuracy(0.99 * smallestAccuracy()), std::invalid_argument);
    EXPECT_THROW(chooseForAccuracy(std::nan("")), std::invalid_argument);
}

TEST(AccuracyChoice, takesThePairSumForFewParticlesOnly)
{
    EXPECT_TRUE(pairSumIsCheaper(13, 1920));
    EXPECT_FALSE(pairSumIsCheaper(10000, 74088));
    // More cells favour the pair sum, more particles the mesh.
    EXPECT_FALSE(pairSumIsCheaper(500, 1000));
    EXPECT_TRUE(pairSumIsCheaper(500, 1000000));
}

TEST(AccuracyChoice, knowsWhereThePairSumIsExact)
{
    Box box;
    box.lower = Vector3::Zero();
    box.upper = Vector3(1, 2, 3);
    FieldSettings settings;
    settings.method = "pairwiseSum";
    EXPECT_EQ(expectedError(settings), 0);
    settings.pairwiseSum.images = true;
    settings.pairwiseSum.imageWalls = wallsOf(box);
    ASSERT_EQ(settings.pairwiseSum.imageWalls.size(), 6U);
    EXPECT_EQ(expectedError(settings), errorBetweenParallelWalls);
    // A corner of three planes has all its images.
    auto& walls = settings.pairwiseSum.imageWalls;
    walls = {walls[0], walls[2], walls[4]};
    EXPECT_EQ(expectedError(settings), 0);
    walls[0].shape = ImageWall::Shape::cylinder;
    EXPECT_TRUE(std::isnan(expectedError(settings)));
    settings.pairwiseSum = {};
    settings.pairwiseSum.truncation = 0.1;
    EXPECT_TRUE(std::isnan(expectedError(settings)));
}

TEST(AccuracyChoice, expectsTheErrorOfTheWeakestPart)
{
    P3mSettings large = chooseForAccuracy(0.005).p3m;
    large.gather = PolynomialOrder::cubic;
    EXPECT_EQ(expectedError(p3mOf(large)), 0.055);
    P3mSettings small;
    small.cloudCells = 1.8;
    EXPECT_TRUE(std::isnan(expectedError(p3mOf(small))));
    FieldSettings him;
    him.method = "him";
    EXPECT_TRUE(std::isnan(expectedError(him)));
}

}  // namespace
}  // namespace him
