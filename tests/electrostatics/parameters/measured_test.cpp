// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/measured.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

double ratio(const std::vector<double>& x)
{
    return x[0] / x[1];
}

TEST(MeasuredQuantities, exactInputsGiveOneNumber)
{
    const Estimate e = estimate({Measured::exact(6), Measured::exact(3)}, ratio);
    for (const double value : {e.value, e.lower95, e.upper95, e.minimum, e.maximum}) {
        EXPECT_EQ(value, 2.0);
    }
}

TEST(MeasuredQuantities, extremesAreThoseOverAllCombinationsOfTheEnds)
{
    const Estimate e = estimate({{6, 5, 8}, {3, 2, 4}}, ratio);
    EXPECT_EQ(e.minimum, 5.0 / 4.0);
    EXPECT_EQ(e.maximum, 8.0 / 2.0);
}

TEST(MeasuredQuantities, theNinetyFivePercentIntervalAddsSingleEffectsInQuadrature)
{
    const Estimate e =
        estimate({{10, 9, 12}, {1, 0.5, 1.5}}, [](const std::vector<double>& x) { return x[0] - 4 * x[1]; });
    EXPECT_DOUBLE_EQ(e.value, 6);
    EXPECT_DOUBLE_EQ(e.lower95, 6 - std::hypot(1, 2));
    EXPECT_DOUBLE_EQ(e.upper95, 6 + std::hypot(2, 2));
}

TEST(MeasuredQuantities, theIntervalIsInsideTheExtremes)
{
    const Estimate e = estimate({{6, 5, 8}, {3, 2, 4}, {1, 0.9, 1.2}},
                                [](const std::vector<double>& x) { return x[0] / x[1] * x[2]; });
    EXPECT_LT(e.minimum, e.lower95);
    EXPECT_LT(e.lower95, e.value);
    EXPECT_LT(e.value, e.upper95);
    EXPECT_LT(e.upper95, e.maximum);
}

TEST(MeasuredQuantities, refusesMoreUncertainInputsThanItCanCombine)
{
    const std::vector<Measured> many(13, Measured{1, 0, 2});
    EXPECT_EQ(refusal([&] { estimate(many, ratio); }),
              "number of inputs with an interval must be at most 12, found 13");
}

}  // namespace
}  // namespace him
