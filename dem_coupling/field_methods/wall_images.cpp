// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/wall_images.hpp"

#include "electrostatics/constants.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace him {

namespace {

/// Planes whose normals have a smaller product than this are perpendicular.
constexpr double perpendicular = 1e-6;

struct Plane {
    Vector3 point, normal;

    Vector3 mirror(const Vector3& x) const { return x + 2 * (point - x).dot(normal) * normal; }
};

/// The wall itself, or the tangent plane of a cylinder where it is nearest to x. On the axis all points are equally near and
/// the first perpendicular direction is taken.
Plane planeFor(const ImageWall& wall, const Vector3& x)
{
    if (wall.shape == ImageWall::Shape::plane) {
        return {wall.point, wall.normal};
    }
    Vector3 radial = (x - wall.point) - (x - wall.point).dot(wall.normal) * wall.normal;
    if (radial.norm() < 1e-12 * wall.radius) {
        radial = wall.normal.unitOrthogonal();
    }
    radial.normalize();
    const Vector3 onAxis = wall.point + (x - wall.point).dot(wall.normal) * wall.normal;
    return {onAxis + wall.radius * radial, radial};
}

bool square(const Plane& a, const Plane& b)
{
    return std::abs(a.normal.dot(b.normal)) < perpendicular;
}

/// Calls add(place, sign) for every image of a unit charge at x.
template <class Add> void mirrorInAll(const std::vector<Plane>& planes, const Vector3& x, const Add& add)
{
    for (std::size_t a = 0; a < planes.size(); ++a) {
        const Vector3 first = planes[a].mirror(x);
        add(first, -1.0);
        for (std::size_t b = a + 1; b < planes.size(); ++b) {
            if (!square(planes[a], planes[b])) {
                continue;
            }
            const Vector3 second = planes[b].mirror(first);
            add(second, 1.0);
            for (std::size_t c = b + 1; c < planes.size(); ++c) {
                if (square(planes[a], planes[c]) && square(planes[b], planes[c])) {
                    add(planes[c].mirror(second), -1.0);
                }
            }
        }
    }
}

/// The planes that the walls are for a charge at x, without those whose images, all of them, lie beyond the reach [m].
void setPlanes(const std::vector<ImageWall>& walls, const Vector3& x, double reach, std::vector<Plane>& planes)
{
    planes.clear();
    for (const ImageWall& wall : walls) {
        const Plane plane = planeFor(wall, x);
        if (2 * std::abs((plane.point - x).dot(plane.normal)) <= reach) {
            planes.push_back(plane);
        }
    }
}

}  // namespace

void WallImages::make(const Points& position, const Scalars& charge, Set& images) const
{
    std::vector<Vector3> places;
    std::vector<double> charges;
    images.owner.clear();
    std::vector<Plane> planes;
    for (Index row = 0; row < position.rows(); ++row) {
        const Vector3 x = position.row(row).matrix().transpose();
        setPlanes(walls_, x, std::numeric_limits<double>::infinity(), planes);
        mirrorInAll(planes, x, [&](const Vector3& place, double sign) {
            places.push_back(place);
            charges.push_back(sign * charge[row]);
            images.owner.push_back(row);
        });
    }
    const auto count = static_cast<Index>(places.size());
    images.position.resize(count, 3);
    images.charge.resize(count);
    for (Index n = 0; n < count; ++n) {
        images.position.row(n) = places[static_cast<std::size_t>(n)].transpose().array();
        images.charge[n] = charges[static_cast<std::size_t>(n)];
    }
}

void WallImages::ownField(const DemParticles& particles, double permittivity, double reach, Points& field) const
{
    field.resize(particles.size(), 3);
    const double coulombConstant = 1.0 / (4.0 * pi * permittivity);
    std::vector<Plane> planes;
    for (Index row = 0; row < particles.size(); ++row) {
        const Vector3 x = particles.position.row(row).matrix().transpose();
        setPlanes(walls_, x, reach, planes);
        Vector3 sum = Vector3::Zero();
        mirrorInAll(planes, x, [&](const Vector3& place, double sign) {
            const Vector3 r = x - place;
            const double distance = r.norm();
            if (distance <= reach) {
                sum += sign / (distance * distance * distance) * r;
            }
        });
        field.row(row) = coulombConstant * particles.charge[row] * sum.transpose().array();
    }
}

}  // namespace him
