// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/charges_by_cell.hpp"
#include "dem_coupling/field_method.hpp"

#include <limits>

namespace him {

/// Hybrid particle-cell method of Pei et al. (HPC in R): charges in cells whose centroids are at most nearCutoff apart act
/// one by one, every other cell acts with its whole charge at its centroid. The mesh only sorts; nothing is solved on it and
/// walls do not act. The near decision is made per pair of cells, never per particle, so that no charge counts twice or not
/// at all.
class HybridParticleCell : public FieldMethod {
public:
    /// Collective. `mesh` outlives the method.
    HybridParticleCell(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox, MPI_Comm communicator,
                       PhaseTimes& times);

    void compute(const DemParticles& particles, ParticleField& result) override;
    /// A partner always acts, one by one or as a share of its cell.
    double partnerCutoff() const override { return std::numeric_limits<double>::infinity(); }
    bool hasPotential() const override { return true; }

private:
    /// Charges at the centroids of the occupied cells of all ranks, contiguous and padded for the kernels.
    struct CellSources {
        Scalars x, y, z;  ///< [m]
        Scalars charge;   ///< [C]
        Index count = 0;
    };
    void gatherOccupiedCells();
    void addFarCells();
    bool isNear(const Vector3& a, const Vector3& b) const;

    FieldSettings settings_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    ChargesByCell cells_;
    CellPairSum near_;
    PairSumResult sums_;
    CellSources far_;
    Scalars cellCharge_;
    std::vector<RowRange> farRanges_;
    std::vector<double> sent_, received_;
    Scalars x_, y_, z_, fieldX_, fieldY_, fieldZ_, potential_;  ///< of the targets
    Eigen::ArrayXXd atTargets_;
};

}  // namespace him
