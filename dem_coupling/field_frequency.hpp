// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

namespace him {

/// Held for the time T, a field lets particles move by what its change over T does not know. Above this omega T [-] approaches to
/// contact lose 7 % of their energy, and a cloud of both signs wins as much; see doc/near_field_refresh.md.
constexpr double driftingFieldPhase = 0.1;

/// The omega T [-] up to which two unlike charges that circle each other next to contact stay together; at 0.80 they part in a third
/// of a turn. Measured by cases/hardCases, scene held.
constexpr double largestFieldPhase = 0.75;

/// Largest omega [1/s] over this rank's particles, omega^2 = 2 |q E|/(m r): the rate at which the force on a particle changes when
/// its field is that of one charge, or of its own image, in contact. Fields that vary over longer lengths have a smaller
/// one, so that this is an upper estimate.
double fieldFrequency(const DemParticles& particles, const Points& field);

/// The same [1/s] for what stays held while the short-range part of the field follows the particles: omega^2 = (2 s Q |q| + 2 |q E|/R)/m,
/// with the gradient s Q of the cloud of the largest charge Q, should it be near, and the field E of all clouds, which varies over
/// lengths of their radius R.
/// @param heldField      E at every row [V/m]
/// @param reach          R [m]
/// @param cloudGradient  s: gradient of the field at the centre of a unit charge's cloud [V/(m2 C)]
/// @param largestCharge  Q, of all ranks [C]
double heldFieldFrequency(const DemParticles& particles, const Points& heldField, double reach, double cloudGradient,
                          double largestCharge);

}  // namespace him
