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

double CloudSources::wallValue(Index row, const BoundaryFaces& faces, Index face, const ChargeCloud& cloud) const
{
    const bool conductor = faces.condition[static_cast<std::size_t>(face)] == FaceCondition::conductor;
    const Vector3 centre = faces.centre.row(face).matrix().transpose();
    const auto of = [&](const Vector3& place) {
        const Vector3 r = centre - place;
        const double distance = r.norm();
        if (distance >= cloud.radius() || distance == 0) {
            return 0.0;
        }
        return conductor ? -cloud.shortRangePotential(distance)
                         : cloud.shortRangeFieldCoefficient(distance) * r.dot(faces.normal.row(face).matrix());
    };
    double sum = of(position.row(row).matrix().transpose());
    for (auto n = static_cast<std::size_t>(firstImage[static_cast<std::size_t>(row)]);
         n < static_cast<std::size_t>(firstImage[static_cast<std::size_t>(row) + 1]); ++n) {
        sum += images[n].sign * of(images[n].position);
    }
    return charge[row] * sum;
}

}  // namespace him
