// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/gas/gas_mesh.hpp"
#include "tests/support/rank_slab.hpp"

#include <Eigen/Cholesky>

#include <array>
#include <mpi.h>

namespace him {

/// A uniform box of cells for tests of the gas's exchange, split over ranks in slabs along x.
class FakeGasMesh : public GasMesh {
public:
    FakeGasMesh(const Box& box, const std::array<Index, 3>& cells, MPI_Comm communicator);

    Box localBounds() const override;
    Index cellCount() const override { return (slab_.last - slab_.first) * cells_[1] * cells_[2]; }
    double largestCellDiagonal() const override { return size_.norm(); }
    Index findCell(const Vector3& point) const override;
    Vector3 cellCentre(Index cell) const override;
    double cellVolume(Index) const override { return size_.prod(); }
    /// As GasMesh says, by a dense matrix of all cells.
    void smooth(Scalars& perVolume, double length) const override;

private:
    Index wholeIndex(Index cell) const { return cell + slab_.first * cells_[1] * cells_[2]; }

    Box box_;
    std::array<Index, 3> cells_;
    MPI_Comm communicator_;
    Vector3 size_;
    RankSlab slab_;  ///< along x
};

}  // namespace him
