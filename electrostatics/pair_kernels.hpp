// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/cloud.hpp"
#include "electrostatics/types.hpp"

#include <cstdint>

namespace him {

/// Two points closer than this [m] count as one position; r^3 stays a normal number above it.
constexpr double smallestDistance = 1e-50;
/// Coordinates and charges beyond this are refused; r^3 stays finite below it.
constexpr double largestCoordinate = 1e50;

/// Rows that the kernels compute together. They touch whole groups: sourcePadding more doubles must follow the last row of
/// every array, readable and finite.
constexpr int laneCount = 4;
constexpr Index sourcePadding = laneCount - 1;

/// Rows [begin, end) of the source arrays.
struct RowRange {
    Index begin;
    Index end;
};

/// Sources as contiguous arrays. The cell centres may be null for the plain Coulomb kernels.
struct SourceArrays {
    const double* x;  ///< [m]
    const double* y;
    const double* z;
    const double* q;      ///< [C]
    const double* cellX;  ///< [m]
    const double* cellY;
    const double* cellZ;

    /// The same arrays from a later row on.
    SourceArrays from(Index row) const
    {
        const bool cells = cellX != nullptr;
        return {x + row,
                y + row,
                z + row,
                q + row,
                cells ? cellX + row : nullptr,
                cells ? cellY + row : nullptr,
                cells ? cellZ + row : nullptr};
    }
};

/// The point whose sums are wanted.
struct PairTarget {
    Vector3 position;    ///< [m]
    Vector3 cellCentre;  ///< [m]
    double charge;       ///< [C], used by the mutual kernels
};

/// Which pairs count.
struct PairLimits {
    double cutoffSquared;    ///< [m2], inclusive
    double sameCellSquared;  ///< [m2] cell centres at most this far apart are one cell
};

/// Where the mutual kernels add what the target does to the sources, in the rows of the sources. The potential may be
/// null for the kernel without double count.
struct ReactionArrays {
    double* x;  ///< [C/m2]
    double* y;
    double* z;
    double* potential;  ///< [C/m]
};

/// Sums over the sources of one target, without the factor 1/(4 pi eps).
struct PairSum {
    Vector3 field = Vector3::Zero();  ///< sum q d / r^3 [C/m2], d from source to target
    double potential = 0;             ///< sum q / r [C/m]
    std::int64_t pairs = 0;           ///< sources within the cutoff
    bool coincident = false;          ///< some source lies on the target; it is left out of the sums
};

/// Coulomb sum (R29) over the sources in the ranges that lie within the cutoff.
PairSum sumCoulomb(const SourceArrays& sources, const RowRange* ranges, int rangeCount, const PairTarget& target,
                   const PairLimits& limits);

/// The same, and every pair is used in both directions: the target's share goes to the reaction arrays.
PairSum sumMutualCoulomb(const SourceArrays& sources, const RowRange* ranges, int rangeCount, const PairTarget& target,
                         const PairLimits& limits, const ReactionArrays& reaction);

/// Coulomb sum less the field between the cell centres of the same pairs (R31), in different cells only. No potential.
PairSum sumWithoutDoubleCount(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                              const PairTarget& target, const PairLimits& limits);

/// The same in both directions.
PairSum sumMutualWithoutDoubleCount(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                                    const PairTarget& target, const PairLimits& limits, const ReactionArrays& reaction);

/// Sum of the short-range part of charge clouds: q d (1/r^3 - F(r)) and q (1/r - psi(r)). The cutoff is the cloud radius.
PairSum sumScreened(const SourceArrays& sources, const RowRange* ranges, int rangeCount, const PairTarget& target,
                    const PairLimits& limits, const ChargeCloud::Coefficients& cloud);

/// The same in both directions.
PairSum sumMutualScreened(const SourceArrays& sources, const RowRange* ranges, int rangeCount, const PairTarget& target,
                          const PairLimits& limits, const ChargeCloud::Coefficients& cloud,
                          const ReactionArrays& reaction);

}  // namespace him
