// SPDX-License-Identifier: GPL-3.0-or-later
// The host program stops at a division by zero, an invalid operation or an overflow in any SIMD lane. Here the same traps
// are set around the pair sums: a trap ends this process.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "tests/electrostatics/pair_sums.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>

namespace him {
namespace {

class FloatingPointTraps : public testing::Test {
protected:
    static constexpr int watched = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;

    void SetUp() override
    {
        std::feclearexcept(FE_ALL_EXCEPT);
        feenableexcept(watched);
    }
    void TearDown() override { fedisableexcept(watched); }

    static void runAll(const ChargedPoints& points, double cutoff)
    {
        for (const PairKernels* kernels : runnablePairKernels()) {
            NearField near(cutoff, epsilon0, *kernels);
            PairSumResult result;
            near.coulomb(points, result);
            EXPECT_TRUE(result.field.isFinite().all());
            near.coulombWithoutDoubleCount(points, result);
            EXPECT_TRUE(result.field.isFinite().all());
            for (const int exponent : {1, 2}) {
                near.screened(points, ChargeCloud(cutoff, exponent), result);
                EXPECT_TRUE(result.field.isFinite().all());
            }
        }
        Points field = Points::Zero(points.targets, 3);
        Scalars potential = Scalars::Zero(points.targets);
        const Points targets = points.position.topRows(points.targets);
        addAllPairs(targets, points.position, points.charge, 0, epsilon0, field, potential);
        EXPECT_TRUE(field.isFinite().all());
    }
};

TEST_F(FloatingPointTraps, stayQuietForEveryNumberOfPoints)
{
    for (Index count = 0; count < 40; ++count) {
        ChargedPoints points = randomPoints(count, 1.0, 1.0, 1.0, 41);
        points.cellCentre.setConstant(0.5);  // all cell distances are zero
        for (const Index targets : {count, count / 2}) {
            points.targets = targets;
            runAll(points, 0.2);
            runAll(points, 50.0);
        }
    }
}

TEST_F(FloatingPointTraps, stayQuietForExtremeCoordinates)
{
    ChargedPoints points = randomPoints(20, 1.0, 1.0, 1.0, 42);
    points.position *= 1e50;
    points.cellCentre = points.position;
    runAll(points, 1e-40);
    runAll(points, 1e50);
    points.position *= 1e-90;
    points.cellCentre.setZero();
    runAll(points, 1e-40);
    runAll(points, 1e50);
}

TEST_F(FloatingPointTraps, leaveRefusalsToTheExceptions)
{
    ChargedPoints points = randomPoints(20, 1.0, 1.0, 1.0, 43);
    points.position.row(4) = points.position.row(5);
    EXPECT_NE(refusal([&] { runAll(points, 0.5); }).find("share the position"), std::string::npos);
    points.position(9, 0) = std::nan("");
    EXPECT_NE(refusal([&] { runAll(points, 0.5); }).find("position of row 9"), std::string::npos);
    points = randomPoints(20, 1.0, 1.0, 1.0, 43);
    points.charge[2] = std::nan("");
    EXPECT_NE(refusal([&] { runAll(points, 0.5); }).find("charge of row 2"), std::string::npos);
    EXPECT_NE(refusal([] { NearField(std::nan(""), epsilon0); }).find("near cutoff"), std::string::npos);
}

TEST_F(FloatingPointTraps, areReallySet)
{
    fedisableexcept(watched);
    EXPECT_DEATH(
        {
            feenableexcept(watched);
            volatile double zero = 0.0;
            volatile double quotient = 1.0 / zero;
            static_cast<void>(quotient);
        },
        "");
}

}  // namespace
}  // namespace him
