// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/reference/grounded_sphere.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

const Vector3 centre(1, -2, 3);
constexpr double radius = 2.5;
constexpr double gaussian = 1 / (4 * pi);

struct Sphere {
    Points position{4, 3};
    Scalars charge{4};
    Points field;
    Scalars potential;

    Sphere()
    {
        position << 0.3, 0.4, -1.1, /**/ -2.0, 1.0, 0.2, /**/ 0, 0, 0, /**/ 0.1, -1.8, 1.3;
        position.rowwise() += centre.transpose().array();
        charge << 1, -0.6, 0.8, 1.4;
    }
    void compute() { computeInGroundedSphere(centre, radius, gaussian, position, charge, field, potential); }
};

TEST(GroundedSphere, pullsOneChargeAsKelvinSays)
{
    const double s = 1.9;
    Points position(1, 3);
    position << 1, -2 + s, 3;
    Scalars charge(1);
    charge << -3e-9;
    Points field;
    Scalars potential;
    computeInGroundedSphere(centre, radius, epsilon0, position, charge, field, potential);
    const double k = -3e-9 / (4 * pi * epsilon0);
    // Image -q a/s at a^2/s pulls outwards with q a s/(a^2 - s^2)^2.
    EXPECT_NEAR(field(0, 1), k * radius * s / std::pow(radius * radius - s * s, 2), 1e-12 * std::abs(k));
    EXPECT_NEAR(field(0, 0), 0, 1e-15 * std::abs(k));
    EXPECT_NEAR(potential[0], -k * radius / (radius * radius - s * s), 1e-12 * std::abs(k));
}

TEST(GroundedSphere, keepsItsSurfaceAtZero)
{
    // A probe without charge just inside the surface.
    Sphere sphere;
    sphere.position.row(1) = (centre + (radius * (1 - 1e-9)) * Vector3(0.48, -0.6, 0.64)).transpose().array();
    sphere.charge[1] = 0;
    sphere.compute();
    EXPECT_LT(std::abs(sphere.potential[1]), 1e-7);
    EXPECT_GT(sphere.potential.abs().maxCoeff(), 0.1);
}

TEST(GroundedSphere, fieldIsTheSlopeOfTheEnergy)
{
    Sphere sphere;
    sphere.compute();
    const double step = 1e-5;
    for (Index row = 0; row < 4; ++row) {
        for (int axis = 0; axis < 3; ++axis) {
            Sphere up;
            Sphere down;
            up.position(row, axis) += step;
            down.position(row, axis) -= step;
            up.compute();
            down.compute();
            const double slope =
                (electrostaticEnergy(up.charge, up.potential) - electrostaticEnergy(down.charge, down.potential))
                / (2 * step);
            EXPECT_NEAR(slope, -sphere.charge[row] * sphere.field(row, axis), 2e-8);
        }
    }
}

TEST(GroundedSphere, refusesAChargeOutside)
{
    Sphere sphere;
    sphere.position.row(2) << 1, -2, 5.5;
    EXPECT_EQ(refusal([&] { sphere.compute(); }),
              "the position of row 2, (1 -2 5.5) m, is not inside the sphere of radius 2.5 m around (1 -2 3) m");
}

}  // namespace
}  // namespace him
