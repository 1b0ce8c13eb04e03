// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/charges_by_cell.hpp"
#include "dem_coupling/field_method.hpp"

#include <limits>

namespace him {

/// Hybrid injection by whole cells (S 2.18 to 2.21): mesh field of the cell, plus the Coulomb field of all charges in
/// interacting cells, less the Coulomb field of every interacting cell's charge between the two cell centres. Two cells
/// interact when the shortest distance between them is below deltaMin; cells that touch always do. The distance is that
/// of the cells' bounding boxes: exact on meshes along the axes, never too large on others.
class HimCell : public FieldMethod {
public:
    /// Collective. `mesh` outlives the method.
    HimCell(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox, const std::array<bool, 3>& periodic,
            MPI_Comm communicator, PhaseTimes& times);

    void compute(const DemParticles& particles, ParticleField& result) override;
    /// A partner always acts: as a charge, or through the mesh alone where its cell does not interact.
    double partnerCutoff() const override { return std::numeric_limits<double>::infinity(); }
    bool hasPotential() const override { return false; }

private:
    void findInteractingCells(const PoissonMesh& mesh);
    void addMeshField();

    FieldSettings settings_;
    PoissonMesh& mesh_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    ChargesByCell cells_;
    CellPairSum near_;
    PairSumResult sums_;
    Scalars cellCharge_, ownCharge_;
    Eigen::ArrayXXd atTargets_;
};

}  // namespace him
