// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include <vector>

namespace LAMMPS_NS {
class Fix;
class LAMMPS;
}  // namespace LAMMPS_NS

namespace him {

/// A wall and the fix that stands for it in LIGGGHTS: the wall fix of a primitive wall, the mesh fix of a mesh wall.
struct ListedWall {
    DemWall wall;
    const LAMMPS_NS::Fix* fix;
};

/// All granular walls of the script, in its order.
std::vector<ListedWall> listWalls(LAMMPS_NS::LAMMPS* lmp);

/// Corners [m] of the facets of a mesh wall that this rank owns; empty for another name.
std::vector<Vector3> pointsOfMeshWall(LAMMPS_NS::LAMMPS* lmp, const std::string& name);

}  // namespace him
