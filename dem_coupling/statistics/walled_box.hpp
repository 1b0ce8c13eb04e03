// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <array>

namespace him {

/// A box along the axes, some of whose sides are walls: the column of a bed, or a part of it.
struct WalledBox {
    Box box;                       ///< [m]
    std::array<bool, 6> walls{};   ///< x lower, x upper, y lower, ...

    struct Nearest {
        double distance;  ///< of the nearest wall [m], negative beyond it; infinity without walls
        Vector3 toWall;   ///< unit vector towards it
    };
    /// The nearest wall of a point; of equally near ones the first.
    Nearest nearest(const Vector3& point) const;
    /// Volume [m3] of the points of the box that are nearer to a wall than this distance [m].
    double volumeWithin(double distance) const;
};

}  // namespace him
