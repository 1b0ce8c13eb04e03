// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/cloud_sources.hpp"

namespace him {

void CloudSources::makeImages(SurroundingsTable& table, double cloudRadius)
{
    firstImage.assign(1, 0);
    images.clear();
    Image found[mostImages];
    for (Index row = 0; row < size(); ++row) {
        const Surroundings& around = table.of(cell[static_cast<std::size_t>(row)]);
        if (!around.planes.empty()) {
            const int count = imagesOf(position.row(row).matrix().transpose(), around, table.planes(), cloudRadius, found);
            images.insert(images.end(), found, found + count);
        }
        firstImage.push_back(static_cast<std::int32_t>(images.size()));
    }
}

}  // namespace him
