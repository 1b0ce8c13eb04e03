// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/mesh_locator.hpp"
#include "dem_coupling/field_method.hpp"

namespace him {

/// Estimate of the self-field of every cell without faces on the edge of the mesh, 0 for the others [1/m2]: the Gauss gradient
/// of a unit charge (4 pi eps = 1) in the cell whose neighbours have Coulomb's potential. Zero in uniform cells.
Scalars unevenness(const MeshArrays& mesh);

/// Solves for a unit charge in a few of the most uneven cells that hold particles and returns the largest field found there in
/// units of the particle's surface field (physics: R31 leaves a particle's own cell alone, and the mesh gradient there is
/// zero only in uniform cells). Collective; leaves the mesh as it was.
/// @param locator  after locate() of these particles
OwnCellField probeOwnCellField(PoissonMesh& mesh, MeshLocator& locator, const DemParticles& particles,
                               double permittivity, MPI_Comm communicator);

}  // namespace him
