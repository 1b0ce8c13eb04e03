// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

namespace LAMMPS_NS {
class Atom;
}

namespace him {

/// The particles that this rank owns, in the order of LIGGGHTS' rows. Not collective.
void readRows(const LAMMPS_NS::Atom& atom, DemParticles& out);

}  // namespace him
