// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/pair_kernels.hpp"
#include "electrostatics/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace him {

/// Points binned into the cells of a box grid and sorted by cell, x fastest, so that a run of cells in x is one
/// contiguous range of places. Memory and time are linear in the number of points; nothing is allocated when a later
/// set of points is not larger.
class LinkedCells {
public:
    /// Cells per reach across (y and z), at most, and along the rows (x): finer cells reject more, shorter rows cost more.
    static constexpr int mostCellsPerReach = 4;
    static constexpr int cellsPerReachAlong = 8;
    /// Rows of cells that a reach touches in y or z: around a box of one cell, one more for round-off.
    static constexpr int rowsAcross = 2 * mostCellsPerReach + 3;

    /// Ranges of places, none of them empty. The array has a spare entry, which is written and not counted.
    struct Ranges {
        std::array<RowRange, rowsAcross * rowsAcross + 1> range;
        int count = 0;

        Index places() const
        {
            Index sum = 0;
            for (int n = 0; n < count; ++n) {
                sum += range[static_cast<std::size_t>(n)].end - range[static_cast<std::size_t>(n)].begin;
            }
            return sum;
        }
    };

    /// Sorts `rows` points from the row `firstRow` on. Throws std::domain_error naming the first row whose position is
    /// not finite.
    /// @param reach           [m] distance up to which the ranges below are complete
    /// @param pointsPerReach  wanted in one reach of a row of cells, where points are evenly spread
    void build(const Points& position, Index firstRow, Index rows, double reach, double pointsPerReach = 8.0);

    Index size() const { return static_cast<Index>(order_.size()); }
    /// Row of the input that stands at each place.
    const std::vector<std::int32_t>& order() const { return order_; }

    /// Rows of cells in x, and where each begins among the places.
    Index rowCount() const { return order_.empty() ? 0 : count_[1] * count_[2]; }
    Index rowBegin(Index row) const { return cellStart_[row * count_[0]]; }

    /// All places that may lie within reach of a point of the box.
    void rangesAround(const Box& box, Ranges& out) const;
    /// Of those only the places from `firstPlace` on, where `firstPlace` follows the places of points inside the box.
    void rangesFrom(Index firstPlace, const Box& box, Ranges& out) const;

private:
    int cellsPerReach(const Vector3& extent, Index points, double pointsPerReach) const;
    void layOut(const Box& bounds, double reach, Index points, double pointsPerReach);
    Index cellAlong(int axis, double coordinate) const;
    double distanceToSlab(int axis, Index slab, const Box& box) const;
    void collect(const Box& box, Index firstSlab, Index firstPlace, Ranges& out) const;

    Vector3 origin_ = Vector3::Zero();
    Vector3 cellSize_ = Vector3::Ones();       ///< [m]
    Vector3 cellsPerMetre_ = Vector3::Ones();  ///< [1/m]
    std::array<Index, 3> count_{1, 1, 1};
    double margin_ = 0;  ///< bound of all round-off in positions and distances [m]
    double reach_ = 0;   ///< the asked reach plus the margin [m]
    std::vector<std::int32_t> order_, cellOfPoint_, cellStart_;
};

}  // namespace him
