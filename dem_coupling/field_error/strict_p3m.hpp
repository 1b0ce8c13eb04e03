// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/field_error.hpp"

namespace him {

/// Reference where nothing exact is known: p3m with larger clouds than the run's, quartic gather and deferred correction, on the
/// same mesh. It leaves the mesh as it found it. Collective in all it does.
class StrictP3mReference : public FieldReference {
public:
    /// @param settings  of the run's method
    StrictP3mReference(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox,
                       const std::array<bool, 3>& periodic, MPI_Comm communicator);

    /// Empty when there is one; else why not, a clause for a message: the mesh has too many cells, or p3m does not accept it.
    /// Collective.
    static std::string whyNot(const FieldSettings& settings, const PoissonMesh& mesh, const Box& demBox,
                              const std::array<bool, 3>& periodic, MPI_Comm communicator);

    void addField(const DemParticles& particles, const Points& targets, const std::vector<Index>& ownRow,
                  Points& field) const override;
    std::string description() const override;

private:
    FieldSettings settings_;
    PoissonMesh& mesh_;
    Box demBox_;
    std::array<bool, 3> periodic_;
    MPI_Comm communicator_;
    mutable PhaseTimes times_;
    mutable std::unique_ptr<FieldMethod> method_;  ///< made at the first measurement
};

}  // namespace him
