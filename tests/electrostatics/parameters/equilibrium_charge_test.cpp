// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/equilibrium_charge.hpp"

#include "electrostatics/constants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace him {
namespace {

constexpr double gravity = 9.81;

/// A polyethylene sphere of Sippola et al. 2018, Table 2.
struct Sphere {
    double diameter = 277e-6;
    double mass = 960 * pi / 6 * 277e-6 * 277e-6 * 277e-6;
};

struct Row {
    double ratio, charge, transferLimit;
};

TEST(EquilibriumCharge, givesTheNumbersOfTheTribochargedBed)
{
    // S2.14 and S2.15 for d = 277 um, 960 kg/m3, g = 9.81 m/s2.
    const Sphere s;
    for (const Row& row : {Row{1, 9.459e-13, 4.432e5}, Row{2, 1.338e-12, 6.268e5}, Row{4, 1.892e-12, 8.864e5},
                           Row{8, 2.675e-12, 1.2535e6}}) {
        const double gamma = transferLimitFor(row.ratio, s.diameter, epsilon0, s.mass, gravity);
        EXPECT_NEAR(gamma / row.transferLimit, 1, 2e-4) << row.ratio;
        EXPECT_NEAR(equilibriumCharge(gamma, s.diameter, epsilon0) / row.charge, 1, 4e-4) << row.ratio;
    }
}

TEST(EquilibriumCharge, hasTheSignOfGammaAndGivesBackTheRatio)
{
    const Sphere s;
    const double gamma = transferLimitFor(3, s.diameter, epsilon0, s.mass, gravity);
    const double charge = equilibriumCharge(-gamma, s.diameter, epsilon0);
    EXPECT_LT(charge, 0);
    EXPECT_NEAR(forceOverWeight(charge, s.diameter, epsilon0, s.mass, gravity), 3, 1e-12);
}

TEST(EquilibriumCharge, makesTheOwnFieldAtTheSurfaceEqualToGamma)
{
    const double charge = equilibriumCharge(5e5, 1e-3, 2 * epsilon0);
    EXPECT_NEAR(charge / (4 * pi * 2 * epsilon0 * 0.5e-3 * 0.5e-3), 5e5, 1e-6);
}

TEST(EquilibriumCharge, refusesLengthsAndWeightsThatAreNotPositive)
{
    EXPECT_THROW(equilibriumCharge(1e5, 0, epsilon0), std::invalid_argument);
    EXPECT_THROW(equilibriumCharge(1e5, 1e-3, -epsilon0), std::invalid_argument);
    EXPECT_THROW(forceOverWeight(1e-12, 1e-3, epsilon0, 1e-6, 0), std::invalid_argument);
    EXPECT_THROW(transferLimitFor(-1, 1e-3, epsilon0, 1e-6, gravity), std::invalid_argument);
}

}  // namespace
}  // namespace him
