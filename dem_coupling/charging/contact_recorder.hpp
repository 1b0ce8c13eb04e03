// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charging_pairs.hpp"

#include <cstdint>
#include <vector>

namespace him {

/// A particle-particle contact whose area grew in this step. Rows are those of the DEM's local and ghost particles.
struct GrowingPair {
    int first;         ///< a particle of this rank
    int second;        ///< its partner, maybe a ghost
    double growth;     ///< dA > 0 [m2]
    double normal[3];  ///< unit vector from first to second
    double area = 0;   ///< now [m2]
    /// Charge that this contact has given to the particle of the lower tag since it began [C]; null where nobody keeps it.
    double* moved = nullptr;
};

/// A particle that touches a wall in this step, growing or not. On a mesh wall one touch per facet.
struct WallTouch {
    int particle;
    int wall;          ///< row of the wall list
    double area;       ///< [m2]
    double normal[3];  ///< unit vector from the particle into the wall
};

/// What the contact model writes down during a force computation and the charging fix works off at the end of the step.
/// The contact model moves no charge itself: it is also called in set-up and by computes.
struct ContactRecorder {
    AreaLaw areaLaw = AreaLaw::hertz;
    double areaFactor = 0;  ///< contact area over effective radius times overlap, of areaLaw
    Reloading reloading = Reloading::counted;
    bool keepsMoved = false;  ///< pairs carry GrowingPair::moved
    std::vector<GrowingPair> pairs;
    std::vector<WallTouch> touches;
    std::int64_t pairsBegun = 0;  ///< contacts that began in this step and that this rank counts

    void clear()
    {
        pairs.clear();
        touches.clear();
        pairsBegun = 0;
    }
};

}  // namespace him
