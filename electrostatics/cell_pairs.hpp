// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/near_field.hpp"
#include "electrostatics/p3m/local_mesh.hpp"

namespace him {

/// Point charges sorted by the cell of the local mesh that holds them: own cells, whose charges are the targets, then the
/// copies around them.
struct ChargesInCells {
    Points position;                     ///< [m]
    Scalars charge;                      ///< [C]
    std::vector<std::int32_t> firstRow;  ///< of each cell, one more than cells
    Index ownCells = 0;

    RowRange rowsOf(Index cell) const
    {
        return {firstRow[static_cast<std::size_t>(cell)], firstRow[static_cast<std::size_t>(cell) + 1]};
    }
    Index targets() const { return firstRow.empty() ? 0 : firstRow[static_cast<std::size_t>(ownCells)]; }
    /// Charge of every cell [C].
    void sumCells(Scalars& cellCharge) const;
};

/// Pair sum over whole cells: every charge meets all charges of its own cell and of the cells near it, whatever their
/// distance (Pei et al.'s near part; S 2.18). Scratch memory is kept between calls.
class CellPairSum {
public:
    /// @param permittivity  eps > 0 [F/m]. Throws std::invalid_argument otherwise.
    explicit CellPairSum(double permittivity, const PairKernels& kernels = *runnablePairKernels().front());

    /// Coulomb field [V/m] and potential [V] at the targets (R29), own charge excluded. Throws std::domain_error when a
    /// target shares the position of another charge or a position or charge is not finite.
    /// @param near  of every own cell the cells near it but not itself, ascending; a list that holds an own cell B for A
    ///              must hold A for B
    void coulomb(const ChargesInCells& charges, const IndexLists& near, PairSumResult& result);

private:
    void load(const ChargesInCells& charges);
    void collectRanges(const ChargesInCells& charges, Index cell, IndexLists::Row near);

    const PairKernels& kernels_;
    double permittivity_;
    Scalars x_, y_, z_, q_;
    Scalars fieldX_, fieldY_, fieldZ_, sumOfPotential_;  ///< without 1/(4 pi eps)
    /// Rows that a cell's targets meet: those used in both directions, the rest of their own cell first, and the copies.
    std::vector<RowRange> mutual_, single_;
};

}  // namespace him
