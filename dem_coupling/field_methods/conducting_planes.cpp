// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/conducting_planes.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

constexpr std::size_t mostPlanes = 16;   ///< more are taken for the facets of a curved wall
constexpr double sameDirection = 1e-8;   ///< 1 - cos of the angle between normals of one plane
constexpr double samePlace = 1e-6;       ///< distance of one plane's points from it, in sizes of the mesh

using Plane = std::array<double, 4>;  ///< unit normal, distance from the origin along it

bool same(const Plane& a, const Plane& b, double size)
{
    return 1 - (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) < sameDirection && std::fabs(a[3] - b[3]) < samePlace * size;
}

void keep(std::vector<Plane>& planes, const Plane& plane, double size)
{
    const auto known = [&](const Plane& other) { return same(plane, other, size); };
    if (planes.size() <= mostPlanes && std::none_of(planes.begin(), planes.end(), known)) {
        planes.push_back(plane);
    }
}

/// Planes of all ranks, in the order of the ranks.
std::vector<Plane> gathered(const std::vector<Plane>& mine, double size, MPI_Comm communicator)
{
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    const int count = static_cast<int>(4 * mine.size());
    std::vector<int> counts(static_cast<std::size_t>(ranks)), starts(static_cast<std::size_t>(ranks), 0);
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t rank = 1; rank < counts.size(); ++rank) {
        starts[rank] = starts[rank - 1] + counts[rank - 1];
    }
    std::vector<Plane> all(static_cast<std::size_t>(starts.back() + counts.back()) / 4);
    MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, communicator);
    std::vector<Plane> planes;
    for (const Plane& plane : all) {
        keep(planes, plane, size);
    }
    return planes;
}

}  // namespace

std::vector<ImageWall> conductingPlanes(const MeshArrays& mesh, MPI_Comm communicator)
{
    const BoundaryFaces& faces = mesh.boundary;
    double size = 0;
    for (Index face = 0; face < faces.size(); ++face) {
        size = std::max(size, faces.centre.row(face).abs().maxCoeff());
    }
    MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_DOUBLE, MPI_MAX, communicator);

    std::vector<Plane> mine;
    for (Index face = 0; face < faces.size(); ++face) {
        if (faces.condition[static_cast<std::size_t>(face)] == FaceCondition::conductor) {
            const Vector3 normal = faces.normal.row(face).matrix().transpose().normalized();
            keep(mine, {normal[0], normal[1], normal[2], normal.dot(faces.centre.row(face).matrix().transpose())}, size);
        }
    }
    const std::vector<Plane> planes = gathered(mine, size, communicator);

    // A mirror plane must have the whole mesh on one side.
    int fits = planes.size() <= mostPlanes;
    for (Index face = 0; fits && face < faces.size(); ++face) {
        for (const Plane& plane : planes) {
            const Vector3 normal(plane[0], plane[1], plane[2]);
            fits = fits && normal.dot(faces.centre.row(face).matrix().transpose()) < plane[3] + samePlace * size;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &fits, 1, MPI_INT, MPI_MIN, communicator);
    std::vector<ImageWall> walls;
    for (const Plane& plane : planes) {
        if (fits) {
            ImageWall wall;
            wall.normal = Vector3(plane[0], plane[1], plane[2]);
            wall.point = plane[3] * wall.normal;
            walls.push_back(wall);
        }
    }
    return walls;
}

}  // namespace him
