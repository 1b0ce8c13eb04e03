// SPDX-License-Identifier: GPL-3.0-or-later
// The short-range part of charge clouds: NearField::screened against the double loop.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "tests/electrostatics/pair_sums.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace him {
namespace {

PairSumResult screened(const ChargedPoints& points, const ChargeCloud& cloud)
{
    PairSumResult result;
    NearField(cloud.radius(), epsilon0).screened(points, cloud, result);
    return result;
}

void expectSame(const PairSumResult& found, const BruteForce& expected)
{
    constexpr double roundOff = 1e-13;
    ASSERT_EQ(found.field.rows(), expected.field.rows());
    EXPECT_EQ(found.pairs, expected.pairs);
    for (Index i = 0; i < expected.field.rows(); ++i) {
        EXPECT_LE((found.field.row(i) - expected.field.row(i)).matrix().norm(), roundOff * expected.fieldScale[i])
            << "row " << i;
        EXPECT_LE(std::abs(found.potential[i] - expected.potential[i]), roundOff * expected.potentialScale[i])
            << "row " << i;
    }
}

class Screened : public testing::TestWithParam<std::tuple<double, int>> {
protected:
    const ChargeCloud cloud{std::get<0>(GetParam()), std::get<1>(GetParam())};
};

TEST_P(Screened, equalsTheDoubleLoopForRandomPoints)
{
    const ChargedPoints points = randomPoints(700, 1.0, 0.7, 1.3, 31);
    expectSame(screened(points, cloud), bruteForceScreened(points, cloud, epsilon0));
}

TEST_P(Screened, equalsTheDoubleLoopForClusters)
{
    const ChargedPoints points = clusteredPoints(500, 32);
    expectSame(screened(points, cloud), bruteForceScreened(points, cloud, epsilon0));
}

TEST_P(Screened, takesSourcesBehindTheTargetsOneSided)
{
    for (const Index targets : {0, 1, 150, 399, 400}) {
        ChargedPoints points = randomPoints(400, 1.0, 1.0, 0.5, 33);
        points.targets = targets;
        expectSame(screened(points, cloud), bruteForceScreened(points, cloud, epsilon0));
    }
}

INSTANTIATE_TEST_SUITE_P(RadiusAndExponent, Screened,
                         testing::Combine(testing::Values(1e-3, 0.03, 0.11, 0.25, 0.5, 1.0, 3.0, 100.0),
                                          testing::Values(1, 2)));

TEST(ScreenedSum, ofAPairAndTheTwoCloudsIsCoulombsLaw)
{
    const double constant = 1.0 / (4.0 * pi * epsilon0);
    ChargedPoints points = randomPoints(2, 1.0, 1.0, 1.0, 34);
    points.position << 0.0, 0.0, 0.0, 0.3, 0.4, 0.0;
    points.charge << 1e-9, -2e-9;
    const ChargeCloud cloud(0.8, 2);
    const PairSumResult result = screened(points, cloud);
    EXPECT_NEAR(result.field(0, 0), constant * 2e-9 * (1.0 / 0.125 - cloud.fieldCoefficient(0.5)) * 0.3, 1e-12);
    EXPECT_NEAR(result.potential[1], constant * 1e-9 * (2.0 - cloud.potential(0.5)), 1e-13);
    EXPECT_EQ(result.pairs, 2);
}

TEST(ScreenedSum, forcesOfAllPairsAddUpToZero)
{
    const ChargedPoints points = clusteredPoints(2000, 35);
    for (const double radius : {0.05, 0.3, 2.0}) {
        const Points force = screened(points, ChargeCloud(radius, 1)).field.colwise() * points.charge;
        EXPECT_LE(force.colwise().sum().abs().maxCoeff(), 1e-13 * force.abs().sum());
    }
}

TEST(ScreenedSum, actsBetweenAParticleAndItsImage)
{
    // A wall at z = 0: the image of the only particle is a row behind it.
    ChargedPoints points = randomPoints(2, 1.0, 1.0, 1.0, 36);
    points.position << 0.2, 0.2, 0.1, 0.2, 0.2, -0.1;
    points.charge << 1e-9, -1e-9;
    points.targets = 1;
    const ChargeCloud cloud(0.5, 1);
    const PairSumResult result = screened(points, cloud);
    ASSERT_EQ(result.field.rows(), 1);
    const double coefficient = cloud.shortRangeFieldCoefficient(0.2);
    EXPECT_NEAR(result.field(0, 2), -1e-9 / (4.0 * pi * epsilon0) * coefficient * 0.2, 1e-11);
    EXPECT_EQ(result.pairs, 1);
}

TEST(ScreenedSum, refusesACloudThatIsNotAsLargeAsTheCutoff)
{
    NearField nearField(0.5, epsilon0);
    PairSumResult result;
    EXPECT_EQ(refusal([&] { nearField.screened(randomPoints(5, 1, 1, 1, 37), ChargeCloud(0.4, 1), result); }),
              "the cloud radius must be the near cutoff, 0.5 m, found 0.4 m");
}

TEST(ScreenedSum, refusesTwoPointsAtOnePosition)
{
    ChargedPoints points = randomPoints(50, 1.0, 1.0, 1.0, 38);
    points.position.row(8) = points.position.row(41);
    points.targets = 20;
    NearField near(0.3, epsilon0);
    PairSumResult result;
    for (const NearPrecision precision : {NearPrecision::doublePrecision, NearPrecision::singlePrecision}) {
        for (const Index targets : {20, 50}) {
            points.targets = targets;
            const std::string found = refusal([&] { near.screened(points, ChargeCloud(0.3, 2), result, precision); });
            EXPECT_NE(found.find("share the position"), std::string::npos) << found;
        }
    }
    points.targets = 20;
    EXPECT_NE(refusal([&] { screened(points, ChargeCloud(0.3, 2)); }).find("rows 8 and 41 share the position"),
              std::string::npos);
}

}  // namespace
}  // namespace him
