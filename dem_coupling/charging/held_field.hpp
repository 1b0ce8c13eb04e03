// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace him {

/// The field handed to the DEM, per row, with the positions and charges that made it: Ex, Ey, Ez [V/m], x, y, z [m], q [C],
/// and the share of the field that the particle's own images and induced charge make [V/m].
struct HeldField {
    static constexpr int width = 10;
    static constexpr int position = 3;     ///< first of its three columns
    static constexpr int ownResponse = 7;  ///< first of its three columns
    const double* first = nullptr;         ///< of row 0, the others follow; null without a field or without room for rows

    const double* row(int i) const { return first + static_cast<std::ptrdiff_t>(width) * i; }
};

}  // namespace him
