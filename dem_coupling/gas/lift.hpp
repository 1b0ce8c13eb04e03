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

/// Whether Saffman's assumptions hold in the least: Re of slip and shear up to one, and that of the slip up to the root of that
/// of the shear; beyond the last the lift is smaller (McLaughlin 1991, J. Fluid Mech. 224, 261). Arguments as above.
inline bool saffmanHolds(double density, double viscosity, double diameter, const Vector3& slip,
                         const Vector3& vorticity)
{
    const double ofSlip = density * slip.norm() * diameter / viscosity;
    const double ofShear = density * vorticity.norm() * diameter * diameter / viscosity;
    return ofSlip <= 1 && ofShear <= 1 && ofSlip * ofSlip <= ofShear;
}

/// The same in words, for the log.
constexpr const char* saffmanRangeInWords =
    "Re of slip and shear up to 1, that of slip up to the root of that of shear";

}  // namespace him
