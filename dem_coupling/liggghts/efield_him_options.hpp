// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/complaints.hpp"
#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/field_settings.hpp"
#include "dem_coupling/liggghts/force_limiter.hpp"

#include <string>
#include <vector>

namespace him {

/// What a line `fix ID group efield/him method NAME keyword value ...` says. See doc/liggghts_him.md.
struct EfieldHimOptions {
    FieldSettings field;
    long every = 1;                         ///< DEM steps between two field updates
    std::vector<std::string> withoutImage;  ///< names of walls that mirror nothing
    WallContactField wallContactField = WallContactField::total;
    ForceLimiter limiter;
};

/// Reads the words behind the style name. Throws std::invalid_argument with everything that is wrong: unknown keywords and
/// methods (the known ones are listed), methods that need a mesh, missing or meaningless numbers, keywords of another method.
EfieldHimOptions readEfieldHimOptions(const std::vector<std::string>& words);

/// Sets field.pairwiseSum.imageWalls from the walls of the script. Complains about a wall that is no plane or cylinder,
/// about images without any wall and about names in withoutImage that no wall has.
void findImageWalls(EfieldHimOptions& options, const std::vector<DemWall>& walls, Complaints& complaints);

}  // namespace him
