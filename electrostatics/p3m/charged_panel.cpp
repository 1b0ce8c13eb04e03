// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/charged_panel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// A quadrangle whose fourth corner leaves the plane of the others by more than this share of its size is not flat.
constexpr double flat = 1e-9;

bool isFlatQuadrangle(const std::vector<Vector3>& polygon)
{
    if (polygon.size() != 4) {
        return false;
    }
    const Vector3 normal = (polygon[2] - polygon[0]).cross(polygon[3] - polygon[1]);
    const double size = std::sqrt(normal.norm());
    return size > 0 && std::abs((polygon[1] - polygon[0]).dot(normal.normalized())) < flat * size;
}

}  // namespace

ChargedPanel panelWith(const std::array<Vector3, 4>& corner, int corners)
{
    ChargedPanel panel;
    panel.corner = corner;
    panel.corners = corners;
    panel.centre.setZero();
    for (int n = 0; n < corners; ++n) {
        panel.centre += corner[static_cast<std::size_t>(n)] / corners;
    }
    Vector3 area = Vector3::Zero();
    for (int n = 0; n < corners; ++n) {
        const Vector3 here = corner[static_cast<std::size_t>(n)] - panel.centre;
        area += 0.5 * here.cross(corner[static_cast<std::size_t>((n + 1) % corners)] - panel.centre);
        panel.radius = std::max(panel.radius, here.norm());
    }
    panel.area = area.norm();
    panel.normal = area / panel.area;
    for (int n = 0; n < corners; ++n) {
        const auto side = static_cast<std::size_t>(n);
        panel.along[side] = (corner[static_cast<std::size_t>((n + 1) % corners)] - corner[side]).normalized();
        panel.outward[side] = panel.along[side].cross(panel.normal);
    }
    return panel;
}

std::vector<ChargedPanel> panelsOf(const std::vector<Vector3>& polygon, double longest)
{
    std::vector<ChargedPanel> panels;
    if (!isFlatQuadrangle(polygon)) {
        Vector3 centre = Vector3::Zero();
        for (const Vector3& corner : polygon) {
            centre += corner / static_cast<double>(polygon.size());
        }
        for (std::size_t n = 0; n < polygon.size(); ++n) {
            panels.push_back(panelWith({centre, polygon[n], polygon[(n + 1) % polygon.size()], centre}, 3));
        }
        return panels;
    }
    const auto& p = polygon;
    const auto pieces = [longest](double a, double b) {
        return std::max(1, static_cast<int>(std::ceil(std::max(a, b) / longest * (1 - 1e-9))));
    };
    const int across = pieces((p[1] - p[0]).norm(), (p[2] - p[3]).norm());
    const int along = pieces((p[3] - p[0]).norm(), (p[2] - p[1]).norm());
    const auto place = [&](int i, int j) -> Vector3 {
        const double u = static_cast<double>(i) / across;
        const double v = static_cast<double>(j) / along;
        return (1 - u) * (1 - v) * p[0] + u * (1 - v) * p[1] + u * v * p[2] + (1 - u) * v * p[3];
    };
    for (int j = 0; j < along; ++j) {
        for (int i = 0; i < across; ++i) {
            panels.push_back(panelWith({place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)}, 4));
        }
    }
    return panels;
}

std::vector<ChargedPanel::Point> ChargedPanel::points() const
{
    std::vector<Point> found;
    if (corners == 3) {
        for (std::size_t n = 0; n < 3; ++n) {
            found.push_back({(4 * corner[n] + corner[(n + 1) % 3] + corner[(n + 2) % 3]) / 6, 1.0 / 3});
        }
        return found;
    }
    const double gauss = 0.5 / std::sqrt(3.0);
    for (const double u : {0.5 - gauss, 0.5 + gauss}) {
        for (const double v : {0.5 - gauss, 0.5 + gauss}) {
            const Vector3 alongU = (1 - v) * (corner[1] - corner[0]) + v * (corner[2] - corner[3]);
            const Vector3 alongV = (1 - u) * (corner[3] - corner[0]) + u * (corner[2] - corner[1]);
            const Vector3 place = corner[0] + u * (corner[1] - corner[0]) + v * (corner[3] - corner[0])
                                  + u * v * (corner[0] - corner[1] + corner[2] - corner[3]);
            found.push_back({place, alongU.cross(alongV).norm() / (4 * area)});
        }
    }
    return found;
}

}  // namespace him
