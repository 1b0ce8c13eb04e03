// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace LAMMPS_NS {
class LAMMPS;
}

namespace him {

/// Registers our fix styles with one LIGGGHTS instance. Call right after its construction, before any script line.
/// Throws std::runtime_error when LIGGGHTS already has a style of that name.
void registerFixes(LAMMPS_NS::LAMMPS* lmp);

}  // namespace him
