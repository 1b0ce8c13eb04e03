// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/wall_offsets.hpp"

#include "electrostatics/constants.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace him {

namespace {

/// Points along each direction of a wall.
constexpr int pointsAlong = 40;

/// Walls that differ by less than this share of the box are one and the same.
constexpr double samePlace = 1e-9;

Vector3 normalOf(const WallFacePolygon& face)
{
    Vector3 normal = Vector3::Zero();
    for (std::size_t n = 1; n + 1 < face.corners.size(); ++n) {
        normal += (face.corners[n] - face.corners[0]).cross(face.corners[n + 1] - face.corners[0]);
    }
    return normal.normalized();
}

Vector3 centreOf(const WallFacePolygon& face)
{
    Vector3 centre = Vector3::Zero();
    for (const Vector3& corner : face.corners) {
        centre += corner / static_cast<double>(face.corners.size());
    }
    return centre;
}

/// From the axis of a cylinder to a point, at right angles to the axis.
Vector3 radialTo(const Vector3& point, const ImageWall& cylinder)
{
    const Vector3 offset = point - cylinder.point;
    return offset - offset.dot(cylinder.normal) * cylinder.normal;
}

/// Where the wall's normal, or the direction away from its axis, points to at a face.
Vector3 directionAt(const ImageWall& wall, const WallFacePolygon& face)
{
    return wall.shape == ImageWall::Shape::plane ? wall.normal : Vector3(radialTo(centreOf(face), wall).normalized());
}

/// Of the middle of a face from a plane, of the whole face from a cylinder [m]: none when it reaches across.
double distance(const ImageWall& wall, const WallFacePolygon& face)
{
    if (wall.shape == ImageWall::Shape::plane) {
        return std::abs((centreOf(face) - wall.point).dot(wall.normal));
    }
    double least = radialTo(centreOf(face), wall).norm();
    double most = least;
    for (const Vector3& corner : face.corners) {
        const double radius = radialTo(corner, wall).norm();
        least = std::min(least, radius);
        most = std::max(most, radius);
    }
    return std::max({0.0, least - wall.radius, wall.radius - most});
}

/// Least and largest distance of the faces of one side.
struct Range {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void add(double value)
    {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    void reduce(MPI_Comm communicator)
    {
        MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, communicator);
        MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, communicator);
    }
};

/// The numbers in the middle of equal parts of an interval.
std::vector<double> middles(double lower, double upper)
{
    std::vector<double> values;
    for (int n = 0; lower < upper && n < pointsAlong; ++n) {
        values.push_back(lower + (n + 0.5) / pointsAlong * (upper - lower));
    }
    return values;
}

/// Which coordinate axis a vector lies along; those of primitive walls all do.
int axisOf(const Vector3& vector)
{
    int axis = 0;
    vector.cwiseAbs().maxCoeff(&axis);
    return axis;
}

bool sameSide(const ImageWall& wall, const Vector3& a, const Vector3& b)
{
    if (wall.shape == ImageWall::Shape::plane) {
        return ((a - wall.point).dot(wall.normal) > 0) == ((b - wall.point).dot(wall.normal) > 0);
    }
    return (radialTo(a, wall).norm() < wall.radius) == (radialTo(b, wall).norm() < wall.radius);
}

}  // namespace

double distanceAlong(const ImageWall& wall, const WallFacePolygon& face)
{
    const double away = distance(wall, face);
    return std::abs(directionAt(wall, face).dot(normalOf(face))) >= alongWall ? away
                                                                              : std::numeric_limits<double>::infinity();
}

WallOffset offsetOf(const ImageWall& wall, const std::vector<WallFacePolygon>& faces, Facing facing,
                    MPI_Comm communicator)
{
    std::array<Range, 2> sides;  // of normals against the wall's direction, and along it
    for (const WallFacePolygon& face : faces) {
        const double away = distanceAlong(wall, face);
        if (std::isfinite(away)) {
            sides[directionAt(wall, face).dot(normalOf(face)) > 0 ? 1 : 0].add(away);
        }
    }
    for (Range& side : sides) {
        side.reduce(communicator);
    }
    const Range& chosen = facing == Facing::either && sides[0].least < sides[1].least ? sides[0] : sides[1];
    WallOffset offset;
    offset.seen = chosen.most >= 0;
    if (offset.seen) {
        offset.nearest = chosen.least;
        offset.farthest = chosen.most;
    }
    return offset;
}

std::vector<Vector3> pointsOfAllRanks(const std::vector<Vector3>& mine, MPI_Comm communicator)
{
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    std::vector<int> counts(static_cast<std::size_t>(ranks)), starts(static_cast<std::size_t>(ranks));
    const int count = 3 * static_cast<int>(mine.size());
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t rank = 1; rank < starts.size(); ++rank) {
        starts[rank] = starts[rank - 1] + counts[rank - 1];
    }
    std::vector<double> own, all(static_cast<std::size_t>(starts.back() + counts.back()));
    for (const Vector3& point : mine) {
        own.insert(own.end(), point.data(), point.data() + 3);
    }
    MPI_Allgatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, communicator);
    std::vector<Vector3> points;
    for (std::size_t n = 0; n < all.size(); n += 3) {
        points.emplace_back(all.data() + n);
    }
    return points;
}

std::vector<Vector3> pointsOfFacets(const std::vector<Vector3>& corners, const Box& box)
{
    std::vector<Vector3> points;
    const auto keep = [&](const Vector3& point) {
        if (box.contains(point)) {
            points.push_back(point);
        }
    };
    for (std::size_t facet = 0; facet + 2 < corners.size(); facet += 3) {
        keep(corners[facet]);
        keep(corners[facet + 1]);
        keep(corners[facet + 2]);
        keep((corners[facet] + corners[facet + 1] + corners[facet + 2]) / 3);
    }
    if (!points.empty()) {
        return points;
    }
    for (std::size_t facet = 0; facet + 2 < corners.size(); facet += 3) {
        const Vector3& origin = corners[facet];
        for (int i = 0; i <= pointsAlong; ++i) {
            for (int j = 0; i + j <= pointsAlong; ++j) {
                keep(origin + (i * (corners[facet + 1] - origin) + j * (corners[facet + 2] - origin)) / pointsAlong);
            }
        }
    }
    return points;
}

std::vector<Vector3> reachablePoints(const std::vector<DemWall>& walls, std::size_t wall, const Vector3& inside,
                                     const Box& box)
{
    const ImageWall& self = walls[wall].image;
    const int axis = axisOf(self.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    // Planes across the wall's own directions cut the box itself, so that the points fill what is left of it.
    Box room = box;
    for (std::size_t other = 0; other < walls.size(); ++other) {
        const ImageWall& plane = walls[other].image;
        if (other == wall || !walls[other].primitive || plane.shape != ImageWall::Shape::plane) {
            continue;
        }
        const int across = axisOf(plane.normal);
        double& lower = room.lower[across];
        double& upper = room.upper[across];
        if (plane.point[across] < inside[across]) {
            lower = std::max(lower, plane.point[across]);
        } else {
            upper = std::min(upper, plane.point[across]);
        }
    }
    std::vector<Vector3> points;
    const auto keep = [&](const Vector3& point) {
        const double margin = samePlace * box.size().norm();
        bool reachable = room.grownBy(margin).contains(point);
        for (std::size_t other = 0; other < walls.size(); ++other) {
            reachable =
                reachable
                && (other == wall || !walls[other].primitive || walls[other].image.shape == ImageWall::Shape::plane
                    || sameSide(walls[other].image, point, inside));
        }
        if (reachable) {
            points.push_back(point);
        }
    };
    Vector3 point = self.point;
    if (self.shape == ImageWall::Shape::plane) {
        for (const double a : middles(room.lower[u], room.upper[u])) {
            for (const double b : middles(room.lower[v], room.upper[v])) {
                point[u] = a;
                point[v] = b;
                keep(point);
            }
        }
        return points;
    }
    for (const double along : middles(room.lower[axis], room.upper[axis])) {
        for (const double angle : middles(0, 2 * pi)) {
            point[axis] = along;
            point[u] = self.point[u] + self.radius * std::cos(angle);
            point[v] = self.point[v] + self.radius * std::sin(angle);
            keep(point);
        }
    }
    return points;
}

}  // namespace him
