// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/cloud.hpp"

#include "electrostatics/constants.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

class Cloud : public testing::TestWithParam<int> {
protected:
    static constexpr double radius = 0.37;
    const ChargeCloud cloud{radius, GetParam()};

    /// Charge inside r by Simpson's rule, which is exact enough for polynomials of degree 6 on 2000 intervals.
    double enclosedCharge(double r) const
    {
        constexpr int intervals = 2000;
        const double step = r / intervals;
        double sum = 0;
        for (int n = 0; n <= intervals; ++n) {
            const double at = n * step;
            const double weight = n == 0 || n == intervals ? 1 : (n % 2 == 1 ? 4 : 2);
            sum += weight * 4.0 * pi * at * at * cloud.density(at);
        }
        return sum * step / 3.0;
    }
};

TEST_P(Cloud, holdsAUnitCharge)
{
    EXPECT_NEAR(enclosedCharge(radius), 1.0, 1e-11);
}

TEST_P(Cloud, obeysGaussLaw)
{
    for (const double u : {0.1, 0.3, 0.5, 0.77, 0.95}) {
        const double r = u * radius;
        EXPECT_NEAR(cloud.fieldCoefficient(r) * r * r * r, enclosedCharge(r), 1e-11);
    }
}

TEST_P(Cloud, fieldIsMinusTheSlopeOfThePotential)
{
    const double step = 1e-5 * radius;
    for (const double u : {0.1, 0.3, 0.5, 0.77, 0.95, 1.3}) {
        const double r = u * radius;
        const double slope = (cloud.potential(r + step) - cloud.potential(r - step)) / (2.0 * step);
        EXPECT_NEAR(-slope, r * cloud.fieldCoefficient(r), 1e-8 / (radius * radius));
    }
}

TEST_P(Cloud, isAPointChargeFromItsRadiusOn)
{
    const double inside = radius * (1.0 - 1e-9);
    EXPECT_NEAR(cloud.potential(inside), 1.0 / inside, 1e-14 / radius);
    EXPECT_NEAR(cloud.fieldCoefficient(inside), 1.0 / (inside * inside * inside), 1e-14 * std::pow(radius, -3));
    EXPECT_NEAR(cloud.density(inside), 0.0, 1e-7 * cloud.density(0.0));
    EXPECT_EQ(cloud.potential(2.0 * radius), 0.5 / radius);
    EXPECT_EQ(cloud.density(radius), 0.0);
}

TEST_P(Cloud, shortRangePartVanishesAtTheRadius)
{
    // k + 2 derivatives of the potential vanish there: close to R it is nothing, beyond it is exactly nothing.
    EXPECT_NEAR(cloud.shortRangePotential(0.999 * radius), 0.0, 1e-8 / radius);
    EXPECT_EQ(cloud.shortRangePotential(radius), 0.0);
    EXPECT_EQ(cloud.shortRangeFieldCoefficient(radius), 0.0);
    EXPECT_EQ(cloud.shortRangeFieldCoefficient(3.0), 0.0);
    const double r = 0.4 * radius;
    EXPECT_DOUBLE_EQ(cloud.shortRangePotential(r) + cloud.potential(r), 1.0 / r);
    EXPECT_DOUBLE_EQ(cloud.shortRangeFieldCoefficient(r) + cloud.fieldCoefficient(r), 1.0 / (r * r * r));
}

TEST_P(Cloud, coefficientsAreThoseOfThePolynomials)
{
    const double r = 0.6 * radius;
    const ChargeCloud::Coefficients& c = cloud.coefficients();
    const double u2 = r * r * c.inverseSquaredRadius;
    EXPECT_NEAR(u2, 0.36, 1e-15);
    EXPECT_DOUBLE_EQ(c.field[0] + c.field[1] * u2 + c.field[2] * u2 * u2, cloud.fieldCoefficient(r));
    EXPECT_DOUBLE_EQ(c.potential[0] + c.potential[1] * u2 + c.potential[2] * u2 * u2 + c.potential[3] * u2 * u2 * u2,
                     cloud.potential(r));
}

INSTANTIATE_TEST_SUITE_P(Exponent, Cloud, testing::Values(1, 2));

TEST(CloudSettings, withoutMeaningAreRefused)
{
    EXPECT_EQ(refusal([] { ChargeCloud(0.0, 1); }), "cloud radius [m] must be > 0 (1e-40 to 1e50), found 0");
    EXPECT_EQ(refusal([] { ChargeCloud(std::nan(""), 1); }), "cloud radius [m] must be > 0 (1e-40 to 1e50), found nan");
    EXPECT_EQ(refusal([] { ChargeCloud(1.0, 3); }), "cloud exponent must be 1 or 2, found 3");
}

}  // namespace
}  // namespace him
