// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/contact_area.hpp"

#include <optional>

namespace him {

/// Elastic constants of a body.
struct Elasticity {
    double youngsModulus = 0;  ///< [Pa]
    double poissonRatio = 0;   ///< [-]
};

/// Effective modulus Y* [Pa] of two bodies (R6): 1/Y* = (1 - nu_a^2)/Y_a + (1 - nu_b^2)/Y_b; without a second one it is
/// rigid. Throws std::invalid_argument for a modulus that is not positive or a Poisson's ratio outside (-1, 0.5].
double effectiveModulus(const Elasticity& a, const std::optional<Elasticity>& b);

/// A sphere before an impact.
struct ImpactBody {
    double radius = 0;   ///< [m]
    double density = 0;  ///< [kg/m3]
    Elasticity elasticity;
};

/// Largest contact area [m2] of an elastic Hertz impact of a sphere on a flat wall, rigid (R25) or elastic.
/// @param normalSpeed  [m/s]
double impactAreaAtWall(const ImpactBody& sphere, const std::optional<Elasticity>& wall, double normalSpeed,
                        AreaLaw law);

/// Largest contact area [m2] of an elastic Hertz impact of two spheres. R26 as printed is 1.516 times this with the area
/// law `hertz`.
/// @param normalSpeed  relative speed along the line of centres [m/s]
double impactAreaOfSpheres(const ImpactBody& a, const ImpactBody& b, double normalSpeed, AreaLaw law);

}  // namespace him
