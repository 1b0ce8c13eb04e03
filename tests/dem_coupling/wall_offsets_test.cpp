// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/wall_offsets.hpp"
#include "electrostatics/constants.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace him {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// This rank's share of some faces.
std::vector<WallFacePolygon> mine(const std::vector<WallFacePolygon>& all)
{
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(world, &rank);
    MPI_Comm_size(world, &ranks);
    std::vector<WallFacePolygon> own;
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (static_cast<int>(n) % ranks == rank) {
            own.push_back(all[n]);
        }
    }
    return own;
}

/// Squares of a tenth of the edge of the unit cube on its side at lower or upper end of an axis; normals out of the cube.
void addSide(std::vector<WallFacePolygon>& faces, int axis, double place, bool upper)
{
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) {
            std::vector<Vector3> corners(4, Vector3::Zero());
            const int di[] = {0, 1, 1, 0};
            const int dj[] = {0, 0, 1, 1};
            for (int n = 0; n < 4; ++n) {
                Vector3& corner = corners[static_cast<std::size_t>(upper ? n : 3 - n)];
                corner[axis] = place;
                corner[u] = 0.1 * (i + di[n]);
                corner[v] = 0.1 * (j + dj[n]);
            }
            faces.push_back({0, corners});
        }
    }
}

std::vector<WallFacePolygon> cube()
{
    std::vector<WallFacePolygon> faces;
    for (int axis = 0; axis < 3; ++axis) {
        addSide(faces, axis, 0, false);
        addSide(faces, axis, 1, true);
    }
    return mine(faces);
}

/// Flat faces between two heights whose edges lie on a cylinder around z; normals away from the axis, or towards it.
std::vector<WallFacePolygon> tube(double radius, int facets, bool away, const Vector3& centre = Vector3::Zero())
{
    std::vector<WallFacePolygon> faces;
    for (int n = 0; n < facets; ++n) {
        std::vector<Vector3> corners;
        for (const auto& [turn, height] :
             {std::pair(0, 0.0), std::pair(1, 0.0), std::pair(1, 1.0), std::pair(0, 1.0)}) {
            const double angle = 2 * pi * (n + turn) / facets;
            corners.push_back(centre + Vector3(radius * std::cos(angle), radius * std::sin(angle), height));
        }
        faces.push_back({0, away ? corners : std::vector<Vector3>(corners.rbegin(), corners.rend())});
    }
    return mine(faces);
}

DemWall plane(int axis, double place)
{
    DemWall wall;
    wall.primitive = true;
    wall.image.normal = Vector3::Unit(axis);
    wall.image.point = place * Vector3::Unit(axis);
    return wall;
}

DemWall cylinder(double radius, const Vector3& axis = Vector3::Zero())
{
    DemWall wall;
    wall.primitive = true;
    wall.image.shape = ImageWall::Shape::cylinder;
    wall.image.normal = Vector3::UnitZ();
    wall.image.point = axis;
    wall.image.radius = radius;
    return wall;
}

Box unitBox()
{
    return {Vector3::Zero(), Vector3::Ones()};
}

TEST(WallOffsets, ofAPlaneIsItsDistanceFromTheNearestParallelFaces)
{
    const WallOffset on = offsetOf(plane(2, 0).image, cube(), Facing::either, world);
    EXPECT_TRUE(on.seen);
    EXPECT_NEAR(on.nearest, 0, 1e-15);
    const WallOffset off = offsetOf(plane(1, 0.93).image, cube(), Facing::either, world);
    EXPECT_TRUE(off.seen);
    EXPECT_NEAR(off.nearest, 0.07, 1e-15);
}

TEST(WallOffsets, lookOnlyAtFacesWhereTheMeshEndsInTheDirectionOfThePlane)
{
    // Near the lower side, but meant as an upper wall.
    EXPECT_NEAR(offsetOf(plane(2, 0.2).image, cube(), Facing::outward, world).nearest, 0.8, 1e-15);
    std::vector<WallFacePolygon> floor;
    addSide(floor, 2, 0, false);
    EXPECT_FALSE(offsetOf(plane(2, 0.2).image, mine(floor), Facing::outward, world).seen);
    EXPECT_TRUE(offsetOf(plane(2, 0.2).image, mine(floor), Facing::either, world).seen);
}

TEST(WallOffsets, areNotSeenWhereNoFaceIsParallel)
{
    std::vector<WallFacePolygon> side;
    addSide(side, 0, 1, true);
    EXPECT_FALSE(offsetOf(plane(2, 0).image, mine(side), Facing::either, world).seen);
    EXPECT_FALSE(offsetOf(plane(2, 0).image, {}, Facing::either, world).seen);
}

TEST(WallOffsets, ofACylinderAreNoneForFlatFacesThatTouchIt)
{
    for (const int facets : {6, 24}) {
        // Edges on the cylinder, middles on it, and something between.
        for (const double radius : {1.0, 1 / std::cos(pi / facets), 0.5 + 0.5 / std::cos(pi / facets)}) {
            const WallOffset offset = offsetOf(cylinder(1).image, tube(radius, facets, true), Facing::either, world);
            EXPECT_TRUE(offset.seen);
            EXPECT_NEAR(offset.farthest, 0, 1e-15) << facets << ' ' << radius;
        }
    }
    EXPECT_NEAR(offsetOf(cylinder(1.2).image, tube(1, 24, true), Facing::either, world).farthest, 0.2, 1e-12);
    EXPECT_NEAR(offsetOf(cylinder(0.9).image, tube(1, 24, true), Facing::either, world).nearest,
                std::cos(pi / 24) - 0.9, 1e-12);
}

TEST(WallOffsets, ofACylinderBesideTheAxisOfTheMeshAreWorstAcross)
{
    const WallOffset offset =
        offsetOf(cylinder(1, Vector3(0.1, 0, 0)).image, tube(1, 240, true), Facing::either, world);
    EXPECT_LT(offset.nearest, 2e-3);
    EXPECT_NEAR(offset.farthest, 0.1, 2e-4);
}

TEST(WallOffsets, ofACylinderInAGapAreThoseOfTheSideThatLiesNearer)
{
    std::vector<WallFacePolygon> both = tube(1, 24, true);
    const std::vector<WallFacePolygon> inner = tube(0.5, 24, false);
    both.insert(both.end(), inner.begin(), inner.end());
    EXPECT_NEAR(offsetOf(cylinder(0.5).image, both, Facing::either, world).farthest, 0, 1e-15);
    EXPECT_NEAR(offsetOf(cylinder(1).image, both, Facing::either, world).farthest, 0, 1e-15);
    EXPECT_NEAR(offsetOf(cylinder(0.5).image, both, Facing::outward, world).nearest, std::cos(pi / 24) - 0.5, 1e-12);
}

TEST(WallOffsets, pointsOfFacetsAreTheCornersOrLieBetweenThem)
{
    const std::vector<Vector3> small{Vector3(0.1, 0.1, 0), Vector3(0.2, 0.1, 0), Vector3(1.1, 0.2, 0)};
    const std::vector<Vector3> found = pointsOfFacets(small, unitBox());
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0], small[0]);
    EXPECT_EQ(found[1], small[1]);
    EXPECT_NEAR((found[2] - Vector3(1.4 / 3, 0.4 / 3, 0)).norm(), 0, 1e-15);
    const std::vector<Vector3> large{Vector3(-9, -9, 0.5), Vector3(20, -9, 0.5), Vector3(-9, 20, 0.5)};
    const std::vector<Vector3> points = pointsOfFacets(large, unitBox());
    EXPECT_FALSE(points.empty());
    for (const Vector3& point : points) {
        EXPECT_TRUE(unitBox().contains(point));
        EXPECT_EQ(point[2], 0.5);
    }
    EXPECT_TRUE(pointsOfFacets({Vector3(2, 2, 2), Vector3(3, 2, 2), Vector3(2, 3, 2)}, unitBox()).empty());
}

TEST(WallOffsets, pointsOfAPlaneLieBetweenTheOtherWalls)
{
    const std::vector<DemWall> walls{plane(2, 0.5), plane(0, 0.2), plane(0, 0.6), plane(1, 0.9), plane(2, 0.7)};
    const std::vector<Vector3> points = reachablePoints(walls, 0, Vector3(0.3, 0.3, 0.5), unitBox());
    EXPECT_EQ(points.size(), 1600u);
    Box found;
    for (const Vector3& point : points) {
        EXPECT_EQ(point[2], 0.5);
        found.extend(point);
    }
    EXPECT_NEAR(found.lower[0], 0.2 + 0.4 / 80, 1e-12);
    EXPECT_NEAR(found.upper[0], 0.6 - 0.4 / 80, 1e-12);
    EXPECT_NEAR(found.lower[1], 0.9 / 80, 1e-12);
    EXPECT_NEAR(found.upper[1], 0.9 - 0.9 / 80, 1e-12);
}

TEST(WallOffsets, pointsOfAPlaneStayInsideOrOutsideOfACylinder)
{
    const std::vector<DemWall> walls{plane(2, 0.5), cylinder(0.3, Vector3(0.5, 0.5, 0))};
    const auto points = reachablePoints(walls, 0, Vector3(0.5, 0.4, 0.5), unitBox());
    EXPECT_NEAR(static_cast<double>(points.size()) / 1600, pi * 0.09, 0.02);
    for (const Vector3& point : points) {
        EXPECT_LT(std::hypot(point[0] - 0.5, point[1] - 0.5), 0.3);
    }
    EXPECT_EQ(reachablePoints(walls, 0, Vector3(0.5, 0.1, 0.5), unitBox()).size(), 1600 - points.size());
}

TEST(WallOffsets, pointsOfACylinderLieOnItBetweenTheOtherWalls)
{
    const std::vector<DemWall> walls{cylinder(0.3, Vector3(0.5, 0.5, 0)), plane(2, 0.25), plane(2, 0.75),
                                     plane(0, 0.5)};
    const auto points = reachablePoints(walls, 0, Vector3(0.6, 0.5, 0.5), unitBox());
    EXPECT_EQ(points.size(), 800u);  // the half beyond x = 0.5
    for (const Vector3& point : points) {
        EXPECT_NEAR(std::hypot(point[0] - 0.5, point[1] - 0.5), 0.3, 1e-12);
        EXPECT_GT(point[0], 0.5 - 1e-8);
        EXPECT_GT(point[2], 0.25);
        EXPECT_LT(point[2], 0.75);
    }
}

}  // namespace
}  // namespace him
