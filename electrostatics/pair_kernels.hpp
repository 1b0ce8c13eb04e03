// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// No Eigen here: the files of the kernels are compiled for instruction sets of their own, and an inline function of a
// library must not be linked from there into the rest of the program.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace him {

/// Two points closer than this [m] count as one position; 1/r^3 stays a normal number above it.
constexpr double smallestDistance = 1e-50;
/// Coordinates and charges beyond this are refused; r^3 stays finite below it.
constexpr double largestCoordinate = 1e50;

/// The kernels compute up to this many rows together and touch whole groups: sourcePadding more doubles must follow the
/// last row of every array, readable and finite.
constexpr int mostLanes = 8;
constexpr std::ptrdiff_t sourcePadding = mostLanes - 1;
/// In single precision as many rows without charge, far from all others, must follow the last row of every range.
constexpr std::ptrdiff_t singlePadding = 2 * mostLanes - 1;

/// Targets that a kernel takes at once, so that every source is loaded once for all of them.
constexpr int mostTargets = 4;

/// Rows [begin, end) of the source arrays.
struct RowRange {
    std::ptrdiff_t begin;
    std::ptrdiff_t end;
};

/// Sources or targets as contiguous arrays. The cell centres may be null but for the kernels without double count.
struct PointArrays {
    const double* x;  ///< [m]
    const double* y;
    const double* z;
    const double* q;      ///< [C]
    const double* cellX;  ///< [m]
    const double* cellY;
    const double* cellZ;

    /// The same arrays from a later row on.
    PointArrays from(std::ptrdiff_t row) const
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

/// Where the sums are added, without the factor 1/(4 pi eps). The kernels without double count leave the potential alone.
struct SumArrays {
    double* x;  ///< sum q d / r^3 [C/m2], d from source to target
    double* y;
    double* z;
    double* potential;  ///< sum q / r [C/m]

    /// The same arrays from a later row on.
    SumArrays from(std::ptrdiff_t row) const { return {x + row, y + row, z + row, potential + row}; }
};

/// Gathered points are closer than this times the cutoff only at one position.
constexpr float smallestSingleDistance = 1e-12F;

/// Points around a place, gathered for the kernels in single precision, in units of the cutoff and of the largest charge, and
/// where their sums are added.
struct GatheredPoints {
    const float* x;
    const float* y;
    const float* z;
    const float* q;
    float* fieldX;
    float* fieldY;
    float* fieldZ;
    float* potential;

    /// The same arrays from a later row on.
    GatheredPoints from(std::ptrdiff_t row) const
    {
        return {x + row, y + row, z + row, q + row, fieldX + row, fieldY + row, fieldZ + row, potential + row};
    }
};

/// Which pairs count, and what the screened kernels take away.
struct PairLimits {
    double cutoffSquared;    ///< [m2], inclusive; the squared cloud radius for the screened kernels
    double sameCellSquared;  ///< [m2] cell centres at most this far apart are one cell
    /// Polynomials of a charge cloud in r^2/R^2, see ChargeCloud::Coefficients.
    double inverseSquaredRadius;
    double cloudPotential[4];
    double cloudField[3];
};

struct PairCount {
    std::int64_t pairs = 0;   ///< that lie within the cutoff
    bool coincident = false;  ///< some source lies on a target; it is left out of the sums

    PairCount& operator+=(const PairCount& other)
    {
        pairs += other.pairs;
        coincident |= other.coincident;
        return *this;
    }
};

/// Adds the sums over the sources in the ranges, one to mostTargets targets at a time. The mutual kernels use every pair in
/// both directions and add what the targets do to the sources to the rows of the sources.
struct PairKernels {
    using Single = PairCount (*)(const PointArrays& targets, int targetCount, const SumArrays& targetSums,
                                 const PointArrays& sources, const RowRange* ranges, int rangeCount,
                                 const PairLimits& limits);
    using Mutual = PairCount (*)(const PointArrays& targets, int targetCount, const SumArrays& targetSums,
                                 const PointArrays& sources, const RowRange* ranges, int rangeCount,
                                 const PairLimits& limits, const SumArrays& sourceSums);
    struct Law {
        Single single;
        Mutual mutual;
    };
    /// In single precision: between the first rows of `targets` and the rows [begin, end) of `points`, which padding follows.
    using Gathered = PairCount (*)(const GatheredPoints& targets, int targetCount, const GatheredPoints& points,
                                   std::ptrdiff_t begin, std::ptrdiff_t end, const PairLimits& limits);
    struct SingleLaw {
        Gathered single;
        Gathered mutual;
    };

    const char* instructionSet;
    Law coulomb;             ///< R29
    Law withoutDoubleCount;  ///< R29 less the field between the cell centres (R31) where these differ; no potential
    Law screened[2];         ///< q d (1/r^3 - F), q (1/r - psi) for the cloud exponents 1 and 2
    SingleLaw screenedInSingle[2];
};

/// The kernels that this machine can run, the fastest first. Pairs at the cutoff are decided alike by all of them.
const std::vector<const PairKernels*>& runnablePairKernels();

}  // namespace him
