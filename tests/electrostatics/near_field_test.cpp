// SPDX-License-Identifier: GPL-3.0-or-later
// R: Rasera et al. 2022, doi 10.1016/j.powtec.2022.117607.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "tests/electrostatics/pair_sums.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace him {
namespace {

PairSumResult coulomb(const ChargedPoints& points, double cutoff)
{
    PairSumResult result;
    NearField(cutoff, epsilon0).coulomb(points, result);
    return result;
}

PairSumResult coulombWithoutDoubleCount(const ChargedPoints& points, double cutoff)
{
    PairSumResult result;
    NearField(cutoff, epsilon0).coulombWithoutDoubleCount(points, result);
    return result;
}

void expectSame(const PairSumResult& found, const BruteForce& expected)
{
    constexpr double roundOff = 1e-13;
    ASSERT_EQ(found.field.rows(), expected.field.rows());
    EXPECT_EQ(found.pairs, expected.pairs);
    for (Index i = 0; i < expected.field.rows(); ++i) {
        const double error = (found.field.row(i) - expected.field.row(i)).matrix().norm();
        EXPECT_LE(error, roundOff * expected.fieldScale[i]) << "row " << i;
        EXPECT_LE(std::abs(found.potential[i] - expected.potential[i]), roundOff * expected.potentialScale[i])
            << "row " << i;
    }
}

ChargedPoints pair(double distance)
{
    ChargedPoints points;
    points.position.setZero(2, 3);
    points.position.row(1) << 0.6 * distance, 0.8 * distance, 0.0;
    points.charge.resize(2);
    points.charge << 1e-9, -2e-9;
    points.targets = 2;
    setCells(points, 0.1);
    return points;
}

TEST(NearField, ofTwoChargesIsCoulombsLaw)
{
    const PairSumResult result = coulomb(pair(5.0), 6.0);
    const double constant = 1.0 / (4.0 * pi * epsilon0);
    // The negative charge at (3, 4, 0) pulls at the positive one; V/m and V.
    EXPECT_NEAR(result.field(0, 0), constant * 2e-9 / 25.0 * 0.6, 1e-15);
    EXPECT_NEAR(result.field(0, 1), constant * 2e-9 / 25.0 * 0.8, 1e-15);
    EXPECT_EQ(result.field(0, 2), 0.0);
    EXPECT_NEAR(result.field(1, 0), constant * 1e-9 / 25.0 * 0.6, 1e-15);
    EXPECT_NEAR(result.potential[0], -constant * 2e-9 / 5.0, 1e-14);
    EXPECT_NEAR(result.potential[1], constant * 1e-9 / 5.0, 1e-14);
    EXPECT_EQ(result.pairs, 2);
}

TEST(NearField, scalesWithThePermittivity)
{
    PairSumResult vacuum;
    PairSumResult dielectric;
    NearField(6.0, epsilon0).coulomb(pair(5.0), vacuum);
    NearField(6.0, 4.0 * epsilon0).coulomb(pair(5.0), dielectric);
    EXPECT_DOUBLE_EQ(vacuum.field(0, 0), 4.0 * dielectric.field(0, 0));
}

TEST(NearField, countsAPairExactlyAtTheCutoff)
{
    EXPECT_EQ(coulomb(pair(5.0), 5.0).pairs, 2);
    EXPECT_EQ(coulomb(pair(5.0), std::nextafter(5.0, 0.0)).pairs, 0);
    EXPECT_EQ(coulomb(pair(5.0), std::nextafter(5.0, 0.0)).field.abs().maxCoeff(), 0.0);
    EXPECT_EQ(coulombWithoutDoubleCount(pair(5.0), 5.0).pairs, 2);
    EXPECT_EQ(coulombWithoutDoubleCount(pair(5.0), std::nextafter(5.0, 0.0)).pairs, 0);
}

class Cutoff : public testing::TestWithParam<double> {};

TEST_P(Cutoff, cellListEqualsTheDoubleLoopForRandomPoints)
{
    const ChargedPoints points = randomPoints(700, 1.0, 0.7, 1.3, 11);
    expectSame(coulomb(points, GetParam()), bruteForce(points, GetParam(), epsilon0, false));
    expectSame(coulombWithoutDoubleCount(points, GetParam()), bruteForce(points, GetParam(), epsilon0, true));
}

TEST_P(Cutoff, cellListEqualsTheDoubleLoopForClusters)
{
    const ChargedPoints points = clusteredPoints(500, 12);
    expectSame(coulomb(points, GetParam()), bruteForce(points, GetParam(), epsilon0, false));
    expectSame(coulombWithoutDoubleCount(points, GetParam()), bruteForce(points, GetParam(), epsilon0, true));
}

TEST_P(Cutoff, cellListEqualsTheDoubleLoopInPlanesAndLines)
{
    for (const auto& edges :
         {Vector3(1, 1, 0), Vector3(1, 0, 1), Vector3(0, 1, 1), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)}) {
        const ChargedPoints points = randomPoints(150, edges.x(), edges.y(), edges.z(), 13);
        expectSame(coulomb(points, GetParam()), bruteForce(points, GetParam(), epsilon0, false));
    }
}

TEST_P(Cutoff, sourcesThatAreNoTargetsActWithoutBeingActedOn)
{
    for (const Index targets : {0, 1, 150, 399, 400}) {
        ChargedPoints points = randomPoints(400, 1.0, 1.0, 0.5, 14);
        points.targets = targets;
        expectSame(coulomb(points, GetParam()), bruteForce(points, GetParam(), epsilon0, false));
        expectSame(coulombWithoutDoubleCount(points, GetParam()), bruteForce(points, GetParam(), epsilon0, true));
    }
}

INSTANTIATE_TEST_SUITE_P(SmallToLargerThanTheBox, Cutoff,
                         testing::Values(1e-3, 0.03, 0.11, 0.25, 0.5, 1.0, 3.0, 100.0));

TEST(NearField, findsNeighboursOnALatticeWhoseSpacingIsTheCutoff)
{
    // Distances on the cutoff and coordinates on the boundaries of the linked cells; far from the origin as well.
    for (const double offset : {0.0, -4.0, 1048576.0}) {
        ChargedPoints points;
        points.position.resize(6 * 6 * 6, 3);
        for (Index i = 0; i < 216; ++i) {
            points.position.row(i) << offset + 0.25 * double(i % 6), offset + 0.25 * double(i / 6 % 6),
                0.25 * double(i / 36);
        }
        points.charge.setConstant(216, 1e-12);
        points.targets = 216;
        EXPECT_EQ(coulomb(points, 0.25).pairs, 2 * 3 * 5 * 6 * 6);
    }
}

TEST(NearField, decidesPairsAtTheCutoffLikeTheDoubleLoopDespiteRoundOff)
{
    for (const double offset : {0.0, 0.3, -77.7, 1234.567}) {
        for (const double spacing : {0.1, 0.07}) {
            ChargedPoints points;
            points.position.resize(7 * 7 * 7, 3);
            for (Index i = 0; i < 343; ++i) {
                points.position.row(i) << offset + spacing * double(i % 7), offset + spacing * double(i / 7 % 7),
                    offset + spacing * double(i / 49);
            }
            points.charge.setConstant(343, 1e-12);
            points.targets = 343;
            for (const int steps : {1, 2, 3}) {
                const double cutoff = spacing * steps;
                EXPECT_EQ(coulomb(points, cutoff).pairs, bruteForce(points, cutoff, epsilon0, false).pairs);
                points.targets = 170;
                EXPECT_EQ(coulomb(points, cutoff).pairs, bruteForce(points, cutoff, epsilon0, false).pairs);
                points.targets = 343;
            }
        }
    }
}

TEST(NearField, forcesOfAllPairsAddUpToZero)
{
    const ChargedPoints points = clusteredPoints(2000, 15);
    for (const double cutoff : {0.05, 0.3, 2.0}) {
        for (const PairSumResult& result : {coulomb(points, cutoff), coulombWithoutDoubleCount(points, cutoff)}) {
            const Points force = result.field.colwise() * points.charge;
            EXPECT_LE(force.colwise().sum().abs().maxCoeff(), 1e-13 * force.abs().sum());
        }
    }
}

TEST(NearField, doesNotDependOnTheOrderOfTheInputBeyondRoundOff)
{
    const ChargedPoints points = randomPoints(900, 1.0, 1.0, 1.0, 16);
    const BruteForce scale = bruteForce(points, 0.3, epsilon0, true);
    const PairSumResult expected = coulombWithoutDoubleCount(points, 0.3);
    std::vector<Index> order(900);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(4));
    ChargedPoints shuffled = points;
    for (Index i = 0; i < 900; ++i) {
        shuffled.position.row(i) = points.position.row(order[i]);
        shuffled.cellCentre.row(i) = points.cellCentre.row(order[i]);
        shuffled.charge[i] = points.charge[order[i]];
    }
    const PairSumResult found = coulombWithoutDoubleCount(shuffled, 0.3);
    EXPECT_EQ(found.pairs, expected.pairs);
    for (Index i = 0; i < 900; ++i) {
        EXPECT_LE((found.field.row(i) - expected.field.row(order[i])).matrix().norm(),
                  1e-13 * scale.fieldScale[order[i]]);
    }
}

TEST(NearField, flippingEveryChargeFlipsTheFieldExactly)
{
    ChargedPoints points = randomPoints(300, 1.0, 1.0, 1.0, 17);
    const PairSumResult result = coulombWithoutDoubleCount(points, 0.4);
    points.charge = -points.charge;
    EXPECT_TRUE((coulombWithoutDoubleCount(points, 0.4).field == -result.field).all());
}

TEST(NearField, correctionLeavesPairsOfOneCellAlone)
{
    ChargedPoints points = randomPoints(60, 0.1, 0.1, 0.1, 18);
    points.cellCentre.setConstant(60, 3, 0.05);
    points.cellCentre.row(7) += 1e-14;  // round-off in a centre does not make another cell
    const Points difference = coulombWithoutDoubleCount(points, 1.0).field - coulomb(points, 1.0).field;
    const Scalars scale = bruteForce(points, 1.0, epsilon0, false).fieldScale;
    EXPECT_LE((difference.matrix().rowwise().norm().array() / scale).maxCoeff(), 4e-16);  // round-off of one product
}

TEST(NearField, correctionOfTwoCellsIsTheFieldBetweenTheirCentres)
{
    ChargedPoints points = pair(5.0);
    points.cellCentre << 0.0, 0.0, 0.0, 2.0, 0.0, 0.0;
    const double constant = 1.0 / (4.0 * pi * epsilon0);
    const PairSumResult result = coulombWithoutDoubleCount(points, 6.0);
    // Centres at x = 0 and 2: the mesh field of the second cell at the first is -q/4 along x; it is taken away.
    EXPECT_NEAR(result.field(0, 0), constant * (2e-9 / 25.0 * 0.6 - 2e-9 / 4.0), 1e-14);
    EXPECT_NEAR(result.field(0, 1), constant * 2e-9 / 25.0 * 0.8, 1e-14);
    EXPECT_EQ(result.potential.abs().maxCoeff(), 0.0);
}

TEST(NearField, ofPointsAtTheirCellCentresVanishes)
{
    ChargedPoints points = randomPoints(200, 1.0, 1.0, 1.0, 19);
    points.cellCentre = points.position;
    EXPECT_EQ(coulombWithoutDoubleCount(points, 0.5).field.abs().maxCoeff(), 0.0);
}

TEST(NearField, handlesNoPointsAndOnePoint)
{
    ChargedPoints none;
    none.position.resize(0, 3);
    none.cellCentre.resize(0, 3);
    none.charge.resize(0);
    EXPECT_EQ(coulomb(none, 1.0).pairs, 0);
    EXPECT_EQ(coulombWithoutDoubleCount(none, 1.0).field.rows(), 0);

    const ChargedPoints one = randomPoints(1, 1.0, 1.0, 1.0, 20);
    EXPECT_EQ(coulomb(one, 1.0).field.abs().maxCoeff(), 0.0);
    EXPECT_EQ(coulomb(one, 1.0).potential[0], 0.0);
}

TEST(NearField, copesWithHugeExtentsAndATinyCutoff)
{
    ChargedPoints points = randomPoints(300, 1.0, 1.0, 1.0, 21);
    points.position.row(0) << 1e12, -3e11, 7e11;
    points.position.row(1) << -1e9, 1e12, 0.0;
    points.position.row(2) = points.position.row(3) + 1e-7;
    setCells(points, 0.1);
    expectSame(coulomb(points, 1e-6), bruteForce(points, 1e-6, epsilon0, false));
    expectSame(coulomb(points, 0.2), bruteForce(points, 0.2, epsilon0, false));
}

TEST(NearField, oneObjectServesChangingNumbersOfPoints)
{
    NearField nearField(0.3, epsilon0);
    PairSumResult result;
    for (const Index count : {400, 3, 0, 700, 120}) {
        ChargedPoints points = randomPoints(count, 1.0, 1.0, 1.0, 22);
        points.targets = count / 2;
        nearField.coulombWithoutDoubleCount(points, result);
        expectSame(result, bruteForce(points, 0.3, epsilon0, true));
        nearField.coulomb(points, result);
        expectSame(result, bruteForce(points, 0.3, epsilon0, false));
    }
}

TEST(NearField, refusesTwoPointsAtOnePosition)
{
    ChargedPoints points = randomPoints(50, 1.0, 1.0, 1.0, 23);
    points.position.row(41) << 0.5, 0.25, 0.125;
    points.position.row(8) = points.position.row(41);
    const std::string expected = "rows 8 and 41 share the position (0.5 0.25 0.125) m; their field would be infinite";
    const std::string other = "rows 41 and 8 share the position (0.5 0.25 0.125) m; their field would be infinite";
    for (const std::string& found :
         {refusal([&] { coulomb(points, 0.3); }), refusal([&] { coulombWithoutDoubleCount(points, 0.3); })}) {
        EXPECT_TRUE(found == expected || found == other) << found;
    }
    points.targets = 20;  // row 41 is now a halo copy on top of a target
    EXPECT_EQ(refusal([&] { coulomb(points, 0.3); }), expected);
}

TEST(NearField, refusesNumbersThatAreNotFinite)
{
    ChargedPoints points = randomPoints(50, 1.0, 1.0, 1.0, 24);
    ChargedPoints bad = points;
    bad.position(17, 1) = std::nan("");
    EXPECT_EQ(refusal([&] { coulomb(bad, 0.3); }), "the position of row 17 must be finite (at most 1e+50), found nan");
    bad = points;
    bad.targets = 10;
    bad.position(49, 2) = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal([&] { coulomb(bad, 0.3); }), "the position of row 49 must be finite (at most 1e+50), found inf");
    bad = points;
    bad.charge[3] = std::nan("");
    EXPECT_EQ(refusal([&] { coulomb(bad, 0.3); }), "the charge of row 3 must be finite (at most 1e+50), found nan");
    bad = points;
    bad.cellCentre(5, 0) = std::nan("");
    EXPECT_EQ(refusal([&] { coulombWithoutDoubleCount(bad, 0.3); }),
              "the cell centre of row 5 must be finite (at most 1e+50), found nan");
}

TEST(NearField, refusesSettingsWithoutMeaning)
{
    EXPECT_EQ(refusal([] { NearField(-1.0, epsilon0); }), "near cutoff [m] must be > 0 (1e-40 to 1e50), found -1");
    EXPECT_EQ(refusal([] { NearField(0.0, epsilon0); }), "near cutoff [m] must be > 0 (1e-40 to 1e50), found 0");
    EXPECT_EQ(refusal([] { NearField(std::nan(""), epsilon0); }),
              "near cutoff [m] must be > 0 (1e-40 to 1e50), found nan");
    EXPECT_EQ(refusal([] { NearField(1.0, 0.0); }), "permittivity must be > 0 and finite, found 0");
}

TEST(NearField, refusesArraysOfDifferentLength)
{
    ChargedPoints points = randomPoints(5, 1.0, 1.0, 1.0, 25);
    ChargedPoints bad = points;
    bad.charge.resize(4);
    EXPECT_EQ(refusal([&] { coulomb(bad, 0.3); }), "the number of charges must match the 5 positions, found 4");
    bad = points;
    bad.cellCentre.resize(0, 3);
    EXPECT_EQ(refusal([&] { coulombWithoutDoubleCount(bad, 0.3); }),
              "the number of cell centres must match the 5 positions, found 0");
    EXPECT_EQ(refusal([&] { coulomb(bad, 0.3); }), "nothing was refused");
    bad = points;
    bad.targets = 6;
    EXPECT_EQ(refusal([&] { coulomb(bad, 0.3); }),
              "the number of targets must lie between 0 and the 5 positions, found 6");
}

}  // namespace
}  // namespace him
