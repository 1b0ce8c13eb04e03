// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace LAMMPS_NS {
class LAMMPS;
}

namespace him {

/// cut_domain AXIS PLACE [PLACE ...]
///
/// A command of DEM scripts: where planes across x, y or z [m] cut the box into the parts of the ranks, in place of parts of
/// equal size. Stands before `processors`, `communicate` and the box; may stand once for every axis. Has no effect on one
/// rank. See doc/cut_domain.md.
void registerCutDomain(LAMMPS_NS::LAMMPS* lmp);

}  // namespace him
