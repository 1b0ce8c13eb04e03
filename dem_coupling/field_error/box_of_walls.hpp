// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/field_error/box_of_mesh.hpp"
#include "dem_coupling/field_settings.hpp"

#include <vector>

namespace him {

/// The grounded box that six planes along the axes enclose, two across each axis; nothing for any other walls.
std::optional<RectangularSpace> boxOfWalls(const std::vector<ImageWall>& walls);

}  // namespace him
