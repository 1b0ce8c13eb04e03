// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

namespace him {

/// Held for the time T, a field lets particles move by what its change over T does not know. Above this omega T [-] straight
/// approaches lose a tenth of their energy and circling ones win more; see doc/near_field_refresh.md.
constexpr double largestFieldPhase = 0.1;

/// Largest omega [1/s] over this rank's particles, omega^2 = 2 |q E|/(m r): the rate at which the force on a particle changes when
/// its field is that of one charge, or of its own image, in contact. Fields that vary over longer lengths have a smaller
/// one, so that this is an upper estimate.
double fieldFrequency(const DemParticles& particles, const Points& field);

}  // namespace him
