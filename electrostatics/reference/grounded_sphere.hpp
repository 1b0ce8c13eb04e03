// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

namespace him {

/// Field [V/m] and potential [V] of point charges inside a grounded sphere, exact: every pair and every Kelvin image
/// (-q a/s at a^2/s from the centre for a charge at s), a charge's own image included and its own Coulomb term left out.
/// Throws std::domain_error naming a row that is not inside the sphere or not finite, or two rows at one position.
/// @param radius        a > 0 [m]
/// @param permittivity  eps > 0 [F/m]
void computeInGroundedSphere(const Vector3& centre, double radius, double permittivity, const Points& position,
                             const Scalars& charge, Points& field, Scalars& potential);

}  // namespace him
