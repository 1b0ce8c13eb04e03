// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/sparse_exchange.hpp"
#include "electrostatics/p3m/local_mesh.hpp"

namespace him {

/// Surrounds a rank's cells with copies of the cells near them, found by walking through the faces of the mesh from rank
/// to rank and from period to period. Brings values of cells and of boundary faces to those copies.
class MeshHalo {
public:
    /// Collective.
    /// @param mesh    this rank's part; outlives the halo
    /// @param reach   [m] copies come of all cells with their centre this near to the box around the own cell centres...
    /// @param layers  ...and of all cells that this many steps through faces reach
    MeshHalo(const MeshArrays& mesh, double reach, int layers, MPI_Comm communicator);

    const LocalMesh& mesh() const { return local_; }

    /// Appends the values of the copies to those of the own cells. Not collective: only neighbours talk.
    void forwardCells(Scalars& values);
    /// The same for boundary faces.
    void forwardFaces(Scalars& values);

    /// Where copies of this rank's cells are: for each own cell (rank, number of the copy there, shift).
    struct Holder {
        std::int32_t rank;
        std::int32_t copy;  ///< cell number in that rank's LocalMesh
        Vector3 shift;      ///< [m] from the cell to its copy
    };
    const std::vector<Holder>& holders() const { return holders_; }
    /// Holders of an own cell: holders()[firstHolder(cell)] up to firstHolder(cell + 1).
    Index firstHolder(Index cell) const { return firstHolder_[static_cast<std::size_t>(cell)]; }
    /// Box around the own cell centres of every rank [m]; empty where a rank has no cells.
    const std::vector<Box>& bounds() const { return bounds_; }

    SparseExchange& exchange() { return exchange_; }

private:
    struct Copy {
        std::int32_t rank;
        std::int32_t cell;
        Vector3 shift;
    };
    void forward(const std::vector<std::vector<std::int32_t>>& sent, const std::vector<std::vector<std::int32_t>>& received,
                 Index own, Index all, Scalars& values);

    SparseExchange exchange_;
    LocalMesh local_;
    std::vector<Box> bounds_;
    std::vector<Holder> holders_;
    std::vector<std::size_t> firstHolder_;
    std::vector<std::vector<std::int32_t>> sentCells_, sentFaces_;          ///< own cells and faces that each rank gets
    std::vector<std::vector<std::int32_t>> receivedCells_, receivedFaces_;  ///< where what each rank sends goes
    SparseExchange::Buffers outgoing_, incoming_;
};

}  // namespace him
