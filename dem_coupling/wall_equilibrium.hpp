// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace him {

/// Where contacts with uncharged, unpolarised walls of one material leave a particle of mean size.
struct WallEquilibrium {
    int particleType = 0;            ///< DEM atom type
    int wallType = 0;                ///< DEM atom type of the walls
    std::vector<std::string> walls;  ///< DemWall::name
    double transferLimit = 0;        ///< Gamma of the particle against the wall [V/m]
    double diameter = 0;             ///< mean of the particles of this type [m]
    double charge = 0;               ///< q_eq [C] \eq S2.14; half of it where the own image counts
    double forceOverWeight = 0;      ///< e/g [-] \eq S2.15; 0 without gravity
};

/// Table for the log, one line per pair of types; empty without any.
std::string describe(const std::vector<WallEquilibrium>& equilibria);

}  // namespace him
