// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/surroundings.hpp"

#include <vector>

namespace him {

/// Charges with their images, as one rank sees them: its targets first, then copies of charges of other ranks and periods.
struct CloudSources {
    Points position;                 ///< [m]
    Scalars charge;                  ///< [C]
    std::vector<std::int32_t> cell;  ///< of the local mesh, that holds the charge; targets are sorted by it
    Index targets = 0;
    std::vector<std::int32_t> firstImage;  ///< one more than rows
    std::vector<Image> images;

    Index size() const { return position.rows(); }
    /// Mirrors every charge in the planes around its cell. Fills firstImage and images.
    void makeImages(SurroundingsTable& table, double cloudRadius);
};

}  // namespace him
