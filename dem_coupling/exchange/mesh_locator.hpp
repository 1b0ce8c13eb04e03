// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/cell_mesh.hpp"
#include "dem_coupling/exchange/sparse_exchange.hpp"

#include <array>
#include <functional>

namespace him {

/// Carries charges from particles to the mesh cells that hold them, and vectors back, where particles and cells live on
/// different ranks. A particle on a face between two ranks belongs to exactly one: to the rank that owns the particle if
/// that rank holds the point, else to the lowest that does.
class MeshLocator {
public:
    /// Collective: every rank learns the bounds of every other rank's cells.
    MeshLocator(const CellMesh& mesh, MPI_Comm communicator);
    /// The same for a DEM box with periodic directions, which the mesh shares. A DEM brings particles back into its box
    /// only when it rebuilds its lists; one that has strayed is sought one period away.
    MeshLocator(const CellMesh& mesh, MPI_Comm communicator, const Box& demBox, const std::array<bool, 3>& periodic);

    /// Finds rank and cell of every position [m]. Collective.
    void locate(const Points& positions);

    /// What locate() found for a row.
    bool inMesh(Index row) const { return owner_[static_cast<std::size_t>(row)] >= 0; }
    /// Centre [m] of the cell that holds each row, or of its periodic copy that does; the row's own position where no cell
    /// does.
    const Points& cellCentre() const { return cellCentre_; }
    /// Rank whose cell holds each row, -1 where no cell does.
    int owner(Index row) const { return owner_[static_cast<std::size_t>(row)]; }
    /// Number of that cell at its rank.
    Index cell(Index row) const { return ownersCell_[static_cast<std::size_t>(row)]; }
    /// From a position to its periodic copy inside the DEM box [m].
    Vector3 shiftIntoBox(const Vector3& position) const;

    /// Charge [C] of this rank's cells: the sum of the charges of all particles in them, of every rank. Rows outside the
    /// mesh give nothing. The sum over all cells equals that over all rows inside to round-off. Only neighbours talk.
    void deposit(const Scalars& charge, Scalars& cellCharge);
    /// The same for several values of every particle at once, one column each, in one message to each neighbour.
    /// @param ofCell  becomes one row per local cell
    void deposit(const Eigen::Ref<const Eigen::ArrayXXd>& ofRow, Eigen::ArrayXXd& ofCell);

    /// One vector per row, taken from the cell that holds it; zero for rows outside. Only neighbours talk.
    /// @param valueOfCell  called with local cells on the rank that owns them
    void gather(const std::function<Vector3(Index)>& valueOfCell, Points& values);
    /// The same for values that lie ready, one row per local cell, any number of columns.
    /// @param ofRow  one row per position, as many columns
    void gather(const Eigen::ArrayXXd& ofCell, Eigen::Ref<Eigen::ArrayXXd> ofRow);
    /// The same with the place of each row inside its cell.
    /// @param positions  those of locate() [m]
    /// @param valueAt    called with local cells and points in them [m], periodic copies brought into the box
    void gather(const Points& positions, const std::function<Vector3(Index, const Vector3&)>& valueAt, Points& values);

private:
    void addToCells(const Eigen::Ref<const Eigen::ArrayXXd>& ofRow, Eigen::Ref<Eigen::ArrayXXd> ofCell);
    /// To the ranks that were asked about rows, one vector for each of their answers: what `incoming_` holds afterwards.
    void answerVectors(const std::function<Vector3(std::size_t, std::size_t)>& valueOfAnswer);
    /// Rows of other ranks' cells from what they have answered.
    void takeAnswers(Points& values) const;

    const CellMesh& mesh_;
    Box demBox_;
    std::array<bool, 3> periodic_;
    SparseExchange exchange_;
    std::vector<Box> bounds_;
    std::vector<int> owner_;         ///< rank of the cell of each row, -1 when there is none
    std::vector<Index> cell_;        ///< local cell of each row that this rank's mesh holds
    std::vector<Index> cellBefore_;  ///< the same at the locate() before: few particles leave their cell in a step
    std::vector<Index> ownersCell_;  ///< the same for every row, numbered by the rank that holds it
    Points cellCentre_;
    std::vector<std::vector<Index>> askedRows_;      ///< rows that each rank was asked about
    std::vector<std::vector<Index>> answeredCells_;  ///< local cells, or -1, of what each rank asked here
    SparseExchange::Buffers outgoing_, incoming_, asked_;
};

}  // namespace him
