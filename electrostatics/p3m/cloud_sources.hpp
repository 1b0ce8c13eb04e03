// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/cloud.hpp"
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

    /// What takes the short-range part of one row and its images out of the mesh potential at a boundary face: on conductors
    /// minus their potential [C/m], on insulated faces minus their outward gradient [C/m2]; without 1/(4 pi eps).
    double wallValue(Index row, const BoundaryFaces& faces, Index face, const ChargeCloud& cloud) const;
};

}  // namespace him
