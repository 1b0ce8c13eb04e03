// SPDX-License-Identifier: GPL-3.0-or-later
// Every instruction set that this machine runs: the same pairs, and the accuracy of the inverse square roots.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "tests/electrostatics/pair_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace him {
namespace {

class InstructionSet : public testing::TestWithParam<const PairKernels*> {
protected:
    const PairKernels& kernels = *GetParam();

    void expectSame(const PairSumResult& found, const BruteForce& expected) const
    {
        EXPECT_EQ(found.pairs, expected.pairs);
        for (Index i = 0; i < expected.field.rows(); ++i) {
            ASSERT_LE((found.field.row(i) - expected.field.row(i)).matrix().norm(), 1e-13 * expected.fieldScale[i])
                << i;
            ASSERT_LE(std::abs(found.potential[i] - expected.potential[i]), 1e-13 * expected.potentialScale[i]) << i;
        }
    }
};

TEST_P(InstructionSet, equalsTheDoubleLoop)
{
    for (const double cutoff : {0.05, 0.2, 0.9}) {
        for (const Index targets : {0, 5, 200, 500}) {
            ChargedPoints points = randomPoints(500, 1.0, 0.8, 1.1, 61);
            points.targets = targets;
            NearField near(cutoff, epsilon0, kernels);
            PairSumResult result;
            near.coulomb(points, result);
            expectSame(result, bruteForce(points, cutoff, epsilon0, false));
            near.coulombWithoutDoubleCount(points, result);
            expectSame(result, bruteForce(points, cutoff, epsilon0, true));
            for (const int exponent : {1, 2}) {
                const ChargeCloud cloud(cutoff, exponent);
                near.screened(points, cloud, result);
                expectSame(result, bruteForceScreened(points, cloud, epsilon0));
            }
        }
    }
}

TEST_P(InstructionSet, equalsTheDoubleLoopToSinglePrecision)
{
    // Far from the origin as well: positions are not rounded.
    for (const double offset : {0.0, 1000.0}) {
        for (const double cutoff : {0.05, 0.2, 0.9}) {
            for (const Index targets : {0, 1, 5, 200, 500}) {
                ChargedPoints points = randomPoints(500, 1.0, 0.8, 1.1, 64);
                points.position += offset;
                points.targets = targets;
                for (const int exponent : {1, 2}) {
                    const ChargeCloud cloud(cutoff, exponent);
                    const BruteForce expected = bruteForceScreened(points, cloud, epsilon0);
                    PairSumResult found;
                    NearField(cutoff, epsilon0, kernels).screened(points, cloud, found, NearPrecision::singlePrecision);
                    EXPECT_EQ(found.pairs, expected.pairs);
                    for (Index i = 0; i < targets; ++i) {
                        ASSERT_LE((found.field.row(i) - expected.field.row(i)).matrix().norm(),
                                  1e-6 * expected.fieldScale[i])
                            << i;
                        ASSERT_LE(std::abs(found.potential[i] - expected.potential[i]),
                                  1e-6 * expected.potentialScale[i])
                            << i;
                    }
                }
            }
        }
    }
}

TEST_P(InstructionSet, singlePrecisionHasNoUnitOfItsOwn)
{
    // Powers of two change nothing but exponents, however small or large: lengths of 1e-9 and 1e9 m, charges of 1e-30 C.
    const ChargedPoints points = randomPoints(60, 1.0, 1.0, 1.0, 65);
    PairSumResult expected;
    NearField(0.5, epsilon0, kernels).screened(points, ChargeCloud(0.5, 2), expected, NearPrecision::singlePrecision);
    for (const int shift : {-30, 30}) {
        const double length = std::ldexp(1.0, shift);
        ChargedPoints scaled = points;
        scaled.position *= length;
        scaled.charge *= std::ldexp(1.0, -66);
        PairSumResult found;
        NearField(0.5 * length, epsilon0, kernels)
            .screened(scaled, ChargeCloud(0.5 * length, 2), found, NearPrecision::singlePrecision);
        const double factor = std::ldexp(1.0, -66) / length / length;
        EXPECT_LE((found.field - factor * expected.field).abs().maxCoeff(),
                  1e-6 * factor * expected.field.abs().maxCoeff());
    }
}

TEST_P(InstructionSet, decidesPairsOnALatticeLikeTheDoubleLoop)
{
    for (const double offset : {0.0, 0.3, 1234.567}) {
        ChargedPoints points = randomPoints(343, 1.0, 1.0, 1.0, 62);
        for (Index i = 0; i < 343; ++i) {
            points.position.row(i) << offset + 0.07 * double(i % 7), offset + 0.07 * double(i / 7 % 7),
                offset + 0.07 * double(i / 49);
        }
        for (const int steps : {1, 2, 3}) {
            const double cutoff = 0.07 * steps;
            PairSumResult result;
            NearField(cutoff, epsilon0, kernels).coulomb(points, result);
            EXPECT_EQ(result.pairs, bruteForce(points, cutoff, epsilon0, false).pairs);
        }
    }
}

TEST_P(InstructionSet, isExactToRoundOffForOnePair)
{
    // Distances over the whole allowed range, with many mantissas.
    double largestError = 0;
    for (double exponent = -39.0; exponent <= 49.0; exponent += 0.0373) {
        const double r = std::pow(10.0, exponent);
        ChargedPoints points = randomPoints(2, 1.0, 1.0, 1.0, 63);
        points.position.setZero();
        points.position(1, 0) = r;
        points.charge << 1.0, 1.0;
        PairSumResult result;
        NearField(std::min(2.0 * r, 1e50), epsilon0, kernels).coulomb(points, result);
        const long double constant = 1.0 / (4.0 * pi * epsilon0);
        const auto relative = [](long double found, long double expected) {
            return std::abs(static_cast<double>(found / expected - 1.0L));
        };
        largestError = std::max(largestError, relative(result.field(0, 0), -constant / r / r));
        largestError = std::max(largestError, relative(result.potential[0], constant / r));
    }
    EXPECT_LE(largestError, 8 * std::numeric_limits<double>::epsilon());
}

INSTANTIATE_TEST_SUITE_P(Of, InstructionSet, testing::ValuesIn(runnablePairKernels()),
                         [](const auto& instance) { return std::string(instance.param->instructionSet); });

}  // namespace
}  // namespace him
