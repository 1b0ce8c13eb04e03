// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/pair_kernels.hpp"
#include "electrostatics/types.hpp"

#include <vector>

namespace him {

/// Charges and sums in single precision, in units of the largest charge and of the cutoff, row by row.
struct SingleRows {
    std::vector<float> charge;
    std::vector<float> fieldX, fieldY, fieldZ, potential;  ///< of the targets

    /// Sets the charges, scaled by 1/unit, and the sums of the first `targets` rows to zero.
    void start(const double* charges, Index rows, double unit, Index targets);
};

/// Points of several ranges side by side, for the kernels in single precision: as offsets from a place in units of a length, so
/// that single precision rounds separations and not positions.
class GatheredRows {
public:
    /// Empties the rows and makes room for `rows` of them and the padding of `ranges` ranges.
    void begin(Index rows, int ranges, const Vector3& place, double length);
    /// Appends the rows of one range. The arrays, positions [m] and scaled charges, must reach to its end.
    void append(const RowRange& range, const PointArrays& points, const float* charge);
    /// Appends the padding that the kernels want after the last row of what they are given.
    void pad();
    /// To be called after the last append. The sums of the first `summed` rows start at zero; those of other rows must not be used.
    GatheredPoints finish(Index summed);
    /// Adds the sums of gathered rows, from `row` on, to the rows of a range.
    void addTo(const RowRange& range, Index row, SingleRows& sums) const;

    Index size() const { return size_; }

private:
    Vector3 place_ = Vector3::Zero();
    double perLength_ = 1;
    Index size_ = 0;
    std::vector<float> x_, y_, z_, q_, fieldX_, fieldY_, fieldZ_, potential_;
};

}  // namespace him
