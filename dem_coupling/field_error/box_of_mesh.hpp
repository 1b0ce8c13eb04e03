// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/poisson_mesh.hpp"
#include "electrostatics/reference/grounded_box.hpp"

#include <array>
#include <mpi.h>
#include <optional>

namespace him {

/// A box and what its sides are.
struct RectangularSpace {
    Box box;
    BoxSides sides;
};

/// The space of the mesh when that is a rectangular box along the axes whose sides are grounded (0 V), insulated or
/// periodic, each all over; nothing otherwise. Collective.
std::optional<RectangularSpace> boxOfMesh(const PoissonMesh& mesh, const std::array<bool, 3>& periodic,
                                          MPI_Comm communicator);

}  // namespace him
