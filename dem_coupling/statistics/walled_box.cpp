// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/statistics/walled_box.hpp"

#include <algorithm>
#include <limits>

namespace him {

WalledBox::Nearest WalledBox::nearest(const Vector3& point) const
{
    Nearest best{std::numeric_limits<double>::infinity(), Vector3::Zero()};
    for (int axis = 0; axis < 3; ++axis) {
        for (int upper = 0; upper < 2; ++upper) {
            if (!walls[static_cast<std::size_t>(2 * axis + upper)]) {
                continue;
            }
            const double distance = upper ? box.upper[axis] - point[axis] : point[axis] - box.lower[axis];
            if (distance < best.distance) {
                best = {distance, (upper ? 1.0 : -1.0) * Vector3::Unit(axis)};
            }
        }
    }
    return best;
}

double WalledBox::volumeWithin(double distance) const
{
    const Vector3 size = box.size();
    double inner = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(2 * axis);
        inner *= std::max(0.0, size[axis] - (walls[a] + walls[a + 1]) * distance);
    }
    return size.prod() - inner;
}

}  // namespace him
