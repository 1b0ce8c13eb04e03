// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/poisson_mesh.hpp"
#include "tests/support/rank_slab.hpp"

#include <array>
#include <functional>
#include <mpi.h>

namespace him {

/// A uniform box mesh for tests: 7-point Laplacian, walls at 0 V half a cell from the outermost centres, central
/// gradient from face averages, as a finite-volume code with linear interpolation does on a hexahedral mesh. Solved
/// exactly by diagonalising the operator of each direction. Cells are split over ranks in slabs along x; every rank
/// solves the whole system.
class BoxMesh : public PoissonMesh {
public:
    /// @param periodic  directions without walls; not all three
    BoxMesh(const Box& box, const std::array<Index, 3>& cells, double permittivity, MPI_Comm communicator,
            const std::array<bool, 3>& periodic = {false, false, false});

    Box localBounds() const override;
    Index cellCount() const override { return (slab_.last - slab_.first) * cells_[1] * cells_[2]; }
    double largestCellDiagonal() const override { return size_.norm(); }
    Index findCell(const Vector3& point) const override;
    Vector3 cellCentre(Index cell) const override;
    void solve(const Scalars& cellCharge) override;
    Vector3 electricField(Index cell) const override;
    double potential(Index cell) const override;
    std::vector<Box> cellBoxes() const override;
    const MeshArrays& arrays() const override { return arrays_; }
    void solve(const Scalars& cellCharge, const Scalars& boundaryValue) override;
    void correct(const Scalars& residual) override;
    bool useMatchedOperator() override;
    void useFiniteVolumeOperator() override { matched_ = false; }

    /// Gives the faces between layers of cells across x a charge per area: those with centres up to `height` above the lower wall.
    /// @param plane  number of the layer below the wall, from 0
    /// @param density  [C/m2] at the centre of a face
    void chargeWall(Index plane, double height, const std::function<double(const Vector3&)>& density);
    std::vector<ChargedFace> chargedFaces() const override { return chargedFaces_; }
    void faceCharges(Scalars& charge) const override { charge = faceCharge_; }

    /// Whether this mesh solves directly, as a uniform grounded box, and so has the matched operator. Off, it stands for a
    /// mesh of any shape.
    bool direct = true;

    double cellVolume() const { return size_.prod(); }
    /// Sum of what the last solve() was given, over all ranks [C].
    double chargeOnMesh() const { return chargeOnMesh_; }

private:
    using Indices = std::array<Index, 3>;
    Indices indicesOf(Index cell) const;
    double at(const Indices& indices) const
    {
        return potential_[indices[0] + cells_[0] * (indices[1] + cells_[1] * indices[2])];
    }
    void transform(Scalars& values, bool back) const;
    void makeArrays();
    /// Potential of all cells for a charge of all cells [C] under walls at 0 V.
    void solveWhole(Scalars& values, bool matched) const;
    Scalars gathered(const Scalars& ownValues) const;

    Box box_;
    Indices cells_;
    std::array<bool, 3> periodic_;
    double permittivity_;
    MPI_Comm communicator_;
    Vector3 size_;
    RankSlab slab_;                               ///< along x
    std::array<Eigen::MatrixXd, 3> modes_;        ///< eigenvectors of -d2/dx2 of each direction
    std::array<Eigen::VectorXd, 3> eigenvalues_;  ///< [1/m2]
    Scalars potential_;                           ///< [V], all cells of all ranks
    double chargeOnMesh_ = 0;
    MeshArrays arrays_;
    bool matched_ = false;
    std::vector<ChargedFace> chargedFaces_;
    Scalars faceCharge_;  ///< [C]
};

}  // namespace him
