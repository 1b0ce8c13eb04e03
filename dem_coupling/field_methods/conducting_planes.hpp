// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/field_settings.hpp"
#include "electrostatics/mesh_arrays.hpp"

#include <mpi.h>
#include <vector>

namespace him {

/// The planes of a mesh's conducting boundary faces, where mirror charges stand for them: in a convex mesh with a few plane
/// sides. Empty for any other mesh (curved walls, baffles, steps). The same on every rank; collective.
std::vector<ImageWall> conductingPlanes(const MeshArrays& mesh, MPI_Comm communicator);

}  // namespace him
