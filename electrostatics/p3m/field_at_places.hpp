// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <algorithm>
#include <array>

namespace him {

/// Some places and what sources do there, side by side, so that a loop over them fills the registers of the processor. Per
/// unit of the factor that the sources are given; with charge/(4 pi eps) [V m] for it they are V/m and V.
struct FieldAtPlaces {
    static constexpr Index most = 64;
    /// Loops run over whole groups of this many places. Every place is then computed by the same instructions, wherever it stands.
    static constexpr Index group = 8;

    using Values = std::array<double, most>;
    alignas(64) Values x, y, z;                 ///< [m]
    alignas(64) Values fieldX, fieldY, fieldZ;  ///< [1/m2]
    alignas(64) Values potential;               ///< [1/m]
    Index count = 0;

    bool full() const { return count == most; }
    void clear() { count = 0; }

    /// Only while not full. What is not kept is overwritten by the next one.
    void append(double atX, double atY, double atZ, bool kept = true)
    {
        const auto n = static_cast<std::size_t>(count);
        count += kept;
        x[n] = atX;
        y[n] = atY;
        z[n] = atZ;
    }

    /// To be called after the last append: fills up the last group and sets all sums to zero.
    void finish()
    {
        const auto filled = static_cast<std::size_t>(count);
        const auto end = static_cast<std::size_t>(places());
        for (std::size_t n = filled; n < end; ++n) {
            x[n] = x[0];
            y[n] = y[0];
            z[n] = z[0];
        }
        for (Values* sums : {&fieldX, &fieldY, &fieldZ, &potential}) {
            std::fill_n(sums->begin(), end, 0.0);
        }
    }

    /// With those that fill up the last group.
    Index places() const { return (count + group - 1) / group * group; }
};

}  // namespace him
