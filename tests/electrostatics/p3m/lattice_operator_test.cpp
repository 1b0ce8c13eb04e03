// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/lattice_operator.hpp"

#include "electrostatics/constants.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

/// A wave whose phase changes by theta from cell to cell.
double wave(double theta, int cell)
{
    return std::cos(theta * cell + 0.4);
}

double secondDifference(double theta, int cell)
{
    return 2 * wave(theta, cell) - wave(theta, cell - 1) - wave(theta, cell + 1);
}

double fourthOrderDifference(double theta, int cell)
{
    return (30 * wave(theta, cell) - 16 * (wave(theta, cell - 1) + wave(theta, cell + 1)) + wave(theta, cell - 2)
            + wave(theta, cell + 2))
           / 12;
}

/// 1 - 0.02 S S of the second difference S.
double matchedDifference(double theta, int cell)
{
    const auto once = [&](int at) { return fourthOrderDifference(theta, at); };
    const auto fourfold = [&](int at) {
        return 6 * once(at) - 4 * (once(at - 1) + once(at + 1)) + once(at - 2) + once(at + 2);
    };
    return once(cell) - 0.02 * fourfold(cell);
}

TEST(LatticeOperator, theSymbolsAreWhatTheStencilsMakeOfAWave)
{
    for (const double theta : {1e-3, 0.3, 1.0, 2.0, 3.0, pi}) {
        for (const int cell : {0, 1, 5}) {
            EXPECT_NEAR(secondDifference(theta, cell), secondDifferenceSymbol(theta) * wave(theta, cell), 1e-14);
            EXPECT_NEAR(matchedDifference(theta, cell), matchedSymbol(theta) * wave(theta, cell), 1e-13);
        }
    }
}

TEST(LatticeOperator, longWavesHaveTheSecondDerivativeToSecondAndToFourthOrder)
{
    // theta^2 - theta^4/12 + ..., and theta^2 - (1/90 + 0.02) theta^6 + ...
    for (const double theta : {0.1, 0.05}) {
        const double square = theta * theta;
        EXPECT_NEAR((secondDifferenceSymbol(theta) / square - 1) / square, -1.0 / 12, 0.01 * square);
        EXPECT_NEAR((matchedSymbol(theta) / square - 1) / (square * square), -(1.0 / 90 + 0.02), 0.1 * square);
    }
}

TEST(LatticeOperator, noWaveIsLostAndShorterOnesWeighMore)
{
    // Zero, or the same for two waves, would leave a potential that no charge makes.
    double second = 0;
    double matched = 0;
    for (int n = 1; n <= 1000; ++n) {
        const double theta = pi * n / 1000;
        EXPECT_GT(secondDifferenceSymbol(theta), second);
        EXPECT_GT(matchedSymbol(theta), matched);
        second = secondDifferenceSymbol(theta);
        matched = matchedSymbol(theta);
    }
}

}  // namespace
}  // namespace him
