// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/cloud.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/require.hpp"

#include <cmath>

namespace him {

namespace {

constexpr double smallestRadius = 1e-40;  ///< [m] the inverse cube stays a normal number
constexpr double largestRadius = 1e50;

}  // namespace

ChargeCloud::ChargeCloud(double radius, int exponent) : radius_(radius), exponent_(exponent)
{
    if (!std::isgreaterequal(radius, smallestRadius) || !std::islessequal(radius, largestRadius)) {
        rejectArgument("cloud radius [m]", "> 0 (1e-40 to 1e50)", radius);
    }
    const double inverse = 1.0 / radius;
    const double inverseCube = inverse * inverse * inverse;
    // The density integrates to 1; the field follows by Gauss' law, the potential by continuity at R.
    if (exponent == 1) {
        centreDensity_ = 15.0 / (8.0 * pi) * inverseCube;
        coefficients_.field = {5.0 / 2.0, -3.0 / 2.0, 0.0};
        coefficients_.potential = {15.0 / 8.0, -10.0 / 8.0, 3.0 / 8.0, 0.0};
    } else if (exponent == 2) {
        centreDensity_ = 105.0 / (32.0 * pi) * inverseCube;
        coefficients_.field = {35.0 / 8.0, -42.0 / 8.0, 15.0 / 8.0};
        coefficients_.potential = {35.0 / 16.0, -35.0 / 16.0, 21.0 / 16.0, -5.0 / 16.0};
    } else {
        rejectArgument("cloud exponent", "1 or 2", exponent);
    }
    coefficients_.inverseSquaredRadius = inverse * inverse;
    for (double& coefficient : coefficients_.field) {
        coefficient *= inverseCube;
    }
    for (double& coefficient : coefficients_.potential) {
        coefficient *= inverse;
    }
}

double ChargeCloud::density(double r) const
{
    const double u = r / radius_;
    const double core = 1.0 - u * u;
    return u < 1.0 ? centreDensity_ * (exponent_ == 1 ? core : core * core) : 0.0;
}

double ChargeCloud::fieldCoefficient(double r) const
{
    if (r >= radius_) {
        return 1.0 / (r * r * r);
    }
    const double u2 = r * r * coefficients_.inverseSquaredRadius;
    const auto& f = coefficients_.field;
    return f[0] + u2 * (f[1] + u2 * f[2]);
}

double ChargeCloud::potential(double r) const
{
    if (r >= radius_) {
        return 1.0 / r;
    }
    const double u2 = r * r * coefficients_.inverseSquaredRadius;
    const auto& p = coefficients_.potential;
    return p[0] + u2 * (p[1] + u2 * (p[2] + u2 * p[3]));
}

double ChargeCloud::shortRangePotential(double r) const
{
    return r < radius_ ? 1.0 / r - potential(r) : 0.0;
}

double ChargeCloud::shortRangeFieldCoefficient(double r) const
{
    return r < radius_ ? 1.0 / (r * r * r) - fieldCoefficient(r) : 0.0;
}

}  // namespace him
