// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/cell_mesh.hpp"
#include "dem_coupling/exchange/sparse_exchange.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace him {

/// Any number of values of every cell; those of a cell side by side.
using CellValues = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

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
    /// does. Not collective.
    /// @param positions  those of locate()
    void cellCentres(const Points& positions, Points& centres) const;
    /// Rank whose cell holds each row, -1 where no cell does.
    int owner(Index row) const { return owner_[static_cast<std::size_t>(row)]; }
    /// Number of that cell at its rank.
    Index cell(Index row) const { return cell_[static_cast<std::size_t>(row)]; }
    /// From a position to its periodic copy inside the DEM box [m].
    Vector3 shiftIntoBox(const Vector3& position) const
    {
        return anyPeriod_ ? shiftOfStray(position) : Vector3(Vector3::Zero());
    }

    /// Charge [C] of this rank's cells: the sum of the charges of all particles in them, of every rank. Rows outside the
    /// mesh give nothing. The sum over all cells equals that over all rows inside to round-off. Only neighbours talk.
    void deposit(const Scalars& charge, Scalars& cellCharge);
    /// The same for N values of every particle at once, in one message to each neighbour.
    /// @param valuesOf  std::array<double, N> of a row; called once for each in the mesh, those of this rank's cells in their order
    /// @param ofCell    becomes one row per local cell
    template <std::size_t N, class ValuesOf> void deposit(const ValuesOf& valuesOf, CellValues& ofCell);

    /// One vector per row, taken from the cell that holds it; zero for rows outside. Only neighbours talk.
    /// @param valueOfCell  called with local cells on the rank that owns them
    void gather(const std::function<Vector3(Index)>& valueOfCell, Points& values);
    /// The same for any number of values that lie ready, one row per local cell.
    /// @param take  called once for every row with its number and its cell's values (const double*)
    template <class Take> void gather(const CellValues& ofCell, const Take& take);
    /// The same with the place of each row inside its cell.
    /// @param positions  those of locate() [m]
    /// @param valueAt    called with local cells and points in them [m], periodic copies brought into the box
    void gather(const Points& positions, const std::function<Vector3(Index, const Vector3&)>& valueAt, Points& values);

private:
    Vector3 shiftOfStray(const Vector3& position) const;
    bool isOwn(std::size_t row) const { return owner_[row] == exchange_.rank(); }
    /// Sends the values of the rows that other ranks were asked about, N of each, and lets `incoming_` hold what comes here.
    template <std::size_t N, class ValuesOf> void sendRows(const ValuesOf& valuesOf);
    /// To the ranks that were asked about rows, one vector for each of their answers: what `incoming_` holds afterwards.
    void answerVectors(const std::function<Vector3(std::size_t, std::size_t)>& valueOfAnswer);
    /// Rows of other ranks' cells from what they have answered.
    void takeAnswers(Points& values) const;

    const CellMesh& mesh_;
    Box demBox_;
    std::array<bool, 3> periodic_;
    bool anyPeriod_;
    SparseExchange exchange_;
    std::vector<Box> bounds_;
    std::vector<int> owner_;          ///< rank of the cell of each row, -1 when there is none
    std::vector<std::int32_t> cell_;  ///< that cell, numbered by its rank
    /// Rows in cells of other ranks, and the centre of the cell, or of its copy that holds the row [m].
    std::vector<std::pair<Index, Vector3>> foreignCentres_;
    std::vector<std::vector<Index>> askedRows_;      ///< rows that each rank was asked about
    std::vector<std::vector<Index>> answeredCells_;  ///< local cells, or -1, of what each rank asked here
    SparseExchange::Buffers outgoing_, incoming_, asked_;
    std::vector<double> nothing_;  ///< zeros for rows outside
    CellValues depositedCharge_;
};

template <std::size_t N, class ValuesOf> void MeshLocator::sendRows(const ValuesOf& valuesOf)
{
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < askedRows_.size(); ++rank) {
        for (const Index row : askedRows_[rank]) {
            const bool taker = owner(row) == static_cast<int>(rank);
            const std::array<double, N> values = taker ? valuesOf(row) : std::array<double, N>{};
            outgoing_[rank].insert(outgoing_[rank].end(), values.begin(), values.end());
        }
        incoming_[rank].resize(N * answeredCells_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);
}

template <std::size_t N, class ValuesOf> void MeshLocator::deposit(const ValuesOf& valuesOf, CellValues& ofCell)
{
    ofCell.setZero(mesh_.cellCount(), N);
    for (std::size_t row = 0; row < cell_.size(); ++row) {
        if (isOwn(row)) {
            const std::array<double, N> values = valuesOf(static_cast<Index>(row));
            double* const cell = ofCell.data() + static_cast<std::size_t>(cell_[row]) * N;
            for (std::size_t k = 0; k < N; ++k) {
                cell[k] += values[k];
            }
        }
    }
    sendRows<N>(valuesOf);
    for (std::size_t rank = 0; rank < answeredCells_.size(); ++rank) {
        const double* in = incoming_[rank].data();
        for (const Index cell : answeredCells_[rank]) {
            for (std::size_t k = 0; k < N; ++k, ++in) {
                if (cell >= 0) {
                    ofCell(cell, static_cast<Index>(k)) += *in;
                }
            }
        }
    }
}

template <class Take> void MeshLocator::gather(const CellValues& ofCell, const Take& take)
{
    const auto columns = static_cast<std::size_t>(ofCell.cols());
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < answeredCells_.size(); ++rank) {
        for (const Index cell : answeredCells_[rank]) {
            for (Index k = 0; k < ofCell.cols(); ++k) {
                outgoing_[rank].push_back(cell >= 0 ? ofCell(cell, k) : 0.0);
            }
        }
        incoming_[rank].resize(columns * askedRows_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);
    nothing_.assign(columns, 0.0);
    for (std::size_t row = 0; row < cell_.size(); ++row) {
        if (isOwn(row)) {
            take(static_cast<Index>(row), ofCell.data() + static_cast<std::size_t>(cell_[row]) * columns);
        } else if (owner_[row] < 0) {
            take(static_cast<Index>(row), nothing_.data());
        }
    }
    for (std::size_t rank = 0; rank < askedRows_.size(); ++rank) {
        for (std::size_t n = 0; n < askedRows_[rank].size(); ++n) {
            if (owner(askedRows_[rank][n]) == static_cast<int>(rank)) {
                take(askedRows_[rank][n], incoming_[rank].data() + n * columns);
            }
        }
    }
}

}  // namespace him
