// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/mesh_locator.hpp"
#include "dem_coupling/exchange/particle_halo.hpp"
#include "dem_coupling/field_method.hpp"
#include "electrostatics/near_field.hpp"

namespace him {

/// `him`, the hybrid of Rasera et al. as published: mesh field of the cell that holds the particle (R30), plus the
/// Coulomb field of the pairs within nearCutoff (R29), minus what the mesh already holds of the same pairs: the Coulomb
/// field between their cell centres (R31).
class Him : public FieldMethod {
public:
    /// Collective. `mesh` outlives this.
    Him(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox, const std::array<bool, 3>& periodic,
        MPI_Comm communicator, PhaseTimes& times);

    void compute(const DemParticles& particles, ParticleField& result) override;
    std::optional<OwnCellField> ownCellField(const DemParticles& particles) override;
    double partnerCutoff() const override { return settings_.nearCutoff; }
    bool hasPotential() const override { return false; }

private:
    /// Unit-charge solves for cells that hold particles for the first time. Collective.
    void extendOwnCellTable(Index particles);
    /// The field that the mesh makes of each particle at its own cell.
    void ownCellResponse(const DemParticles& particles, Points& field);
    void addMeshField(const DemParticles& particles, ParticleField& result);
    void sumNear(bool someExcluded);
    void sumNearWithExcluded();

    FieldSettings settings_;
    PoissonMesh& mesh_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    MeshLocator locator_;
    ParticleHalo halo_;
    NearField near_;
    ChargedPoints points_;
    PairSumResult sums_, partialSums_;
    std::vector<Vector3> ownCellField_;  ///< at a cell of a charge of 1 C in it [V/(m C)]
    std::vector<bool> ownCellKnown_;
    Scalars cellCharge_, inMesh_;
};

}  // namespace him
