// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace him {

/// Lift on a sphere in a shear flow (Saffman 1965, J. Fluid Mech. 22, 385, with the corrigendum of 1968, 31, 624):
///     F = 1.615 d^2 sqrt(rho mu/|w|) (slip x w)  [N].
/// A sphere that lags behind the gas is drawn to where the gas is faster. Holds for Re of slip and shear far below one, without
/// neighbours or walls; no correction for larger ones is made.
/// @param density    of the gas [kg/m3]
/// @param viscosity  dynamic [Pa s]
/// @param diameter   [m]
/// @param slip       velocity of the gas less that of the sphere [m/s]
/// @param vorticity  w = curl of the gas velocity [1/s]; zero gives no lift
inline Vector3 saffmanLift(double density, double viscosity, double diameter, const Vector3& slip,
                           const Vector3& vorticity)
{
    constexpr double saffman = 1.615;  // 6.46/4, of the radius in the source
    const double size = vorticity.norm();
    if (size == 0) {
        return Vector3::Zero();
    }
    return saffman * diameter * diameter * std::sqrt(density * viscosity / size) * slip.cross(vorticity);
}

}  // namespace him
