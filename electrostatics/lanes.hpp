// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Four doubles that are computed together, written with the compiler's vector extension: one source for every
// instruction set, and no licence for the compiler to reorder or speculate floating point operations.

#include "electrostatics/pair_kernels.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace him {

using Lanes = double __attribute__((vector_size(laneCount * sizeof(double))));
/// All bits set where a comparison of Lanes holds, else none.
using LaneMask = std::int64_t __attribute__((vector_size(laneCount * sizeof(std::int64_t))));

#define HIM_INLINE inline __attribute__((always_inline))

HIM_INLINE Lanes allLanes(double value)
{
    return Lanes{value, value, value, value};
}

/// Four consecutive values; all four must be readable.
HIM_INLINE Lanes loadLanes(const double* values)
{
    Lanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

HIM_INLINE void storeLanes(double* values, Lanes lanes)
{
    std::memcpy(values, &lanes, sizeof lanes);
}

/// Square root of each lane. Becomes one instruction when square roots do not set errno (-fno-math-errno).
HIM_INLINE Lanes squareRoot(Lanes a)
{
    return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

HIM_INLINE double sumOf(Lanes a)
{
    return (a[0] + a[1]) + (a[2] + a[3]);
}

HIM_INLINE std::int64_t sumOf(LaneMask a)
{
    return (a[0] + a[1]) + (a[2] + a[3]);
}

}  // namespace him
