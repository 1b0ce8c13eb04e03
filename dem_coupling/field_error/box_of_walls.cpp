// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_error/box_of_walls.hpp"

#include <algorithm>
#include <cmath>

namespace him {

std::optional<RectangularSpace> boxOfWalls(const std::vector<ImageWall>& walls)
{
    constexpr double almostOne = 1 - 1e-12;
    std::array<std::vector<double>, 3> places;
    for (const ImageWall& wall : walls) {
        bool along = false;
        for (int axis = 0; axis < 3 && wall.shape == ImageWall::Shape::plane; ++axis) {
            if (std::abs(wall.normal[axis]) > almostOne) {
                places[static_cast<std::size_t>(axis)].push_back(wall.point[axis]);
                along = true;
            }
        }
        if (!along) {
            return std::nullopt;
        }
    }
    RectangularSpace space;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& two = places[static_cast<std::size_t>(axis)];
        if (two.size() != 2 || two[0] == two[1]) {
            return std::nullopt;
        }
        space.box.lower[axis] = std::min(two[0], two[1]);
        space.box.upper[axis] = std::max(two[0], two[1]);
    }
    return space;
}

}  // namespace him
