// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/exchange/wall_faces.hpp"

#include <vector>

namespace him {

/// Normals this near to that of a wall (cosine of about 18 degrees) belong to faces along it.
constexpr double alongWall = 0.95;

/// How far the faces of a mesh that stand for a plane or cylinder of the DEM scene lie off it. Equal on all ranks.
struct WallOffset {
    bool seen = false;    ///< some face looks the wall's way; the rest holds only then
    double nearest = 0;   ///< least distance of a face from the wall [m]
    double farthest = 0;  ///< largest one [m]
};

/// Which faces may stand for a wall: those on any side of the mesh, or only those where the mesh ends in the direction of the
/// plane's normal, or away from the cylinder's axis.
enum class Facing { either, outward };

/// Distance [m] of a face along a primitive wall from it; infinity when its normal says that it does not belong to the wall.
double distanceAlong(const ImageWall& wall, const WallFacePolygon& face);

/// Offset of a primitive wall from faces whose normals point out of the mesh. Around a cylinder flat faces touch it somewhere
/// and stand off elsewhere; they count as lying on it. Where faces look towards the axis and away from it, as in a gap
/// between two cylinders, those that lie nearer are taken. Collective.
/// @param faces  this rank's
WallOffset offsetOf(const ImageWall& wall, const std::vector<WallFacePolygon>& faces, Facing facing,
                    MPI_Comm communicator);

/// The points of all ranks, rank by rank. Collective.
std::vector<Vector3> pointsOfAllRanks(const std::vector<Vector3>& mine, MPI_Comm communicator);

/// Points [m] of a mesh wall of the DEM scene that lie in a box: corners and centres of its facets or, where facets are so large
/// that none of these does, points spread over them. Not collective.
/// @param corners  three per facet
std::vector<Vector3> pointsOfFacets(const std::vector<Vector3>& corners, const Box& box);

/// Points [m] spread over the part of a primitive wall that particles can reach: in the box, and on the same side of every
/// other primitive wall as `inside` is. Strips along the edges narrower than 1/80 of its width hold none. Not collective.
/// @param wall  its row in `walls`
std::vector<Vector3> reachablePoints(const std::vector<DemWall>& walls, std::size_t wall, const Vector3& inside,
                                     const Box& box);

}  // namespace him
