// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/wall_faces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <mpi.h>

namespace him {
namespace {

constexpr double edge = 0.25;  // of a face [m]

int rankOf()
{
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

int ranksOf()
{
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    return ranks;
}

/// Square face number n of a strip along x at height z.
WallFacePolygon square(int n, double z, int wall)
{
    const double x = n * edge;
    return {wall, {Vector3(x, 0, z), Vector3(x + edge, 0, z), Vector3(x + edge, edge, z), Vector3(x, edge, z)}};
}

/// Two strips of eight faces, wall 0 below and wall 1 above, dealt out to the ranks.
std::vector<WallFacePolygon> mine()
{
    std::vector<WallFacePolygon> faces;
    for (int n = 0; n < 8; ++n) {
        if (n % ranksOf() == rankOf()) {
            faces.push_back(square(n, 0, 0));
            faces.push_back(square(n, 1, 1));
        }
    }
    return faces;
}

TEST(WallFaces, findsTheFaceUnderAPointAndItsDistance)
{
    const WallFaces faces(mine(), 0.05, MPI_COMM_WORLD);
    const WallFaces::Place place = faces.find(Vector3(1.3, 0.1, -0.03), WallFaces::anyWall);
    ASSERT_GE(place.face, 0);
    EXPECT_NEAR(place.distance, 0.03, 1e-15);
    EXPECT_NEAR((faces.centreOf(place.face) - Vector3(1.375, 0.125, 0)).norm(), 0, 1e-15);
    EXPECT_NEAR(std::abs(faces.normalOf(place.face)[2]), 1, 1e-15);
}

TEST(WallFaces, findsNothingBeyondItsReachOrOnAnotherWall)
{
    const WallFaces faces(mine(), 0.05, MPI_COMM_WORLD);
    EXPECT_LT(faces.find(Vector3(1.3, 0.1, 0.051), WallFaces::anyWall).face, 0);
    EXPECT_LT(faces.find(Vector3(1.3, 0.1, 0.01), 1).face, 0);
    EXPECT_GE(faces.find(Vector3(1.3, 0.1, 0.99), 1).face, 0);
    EXPECT_LT(faces.find(Vector3(50, 0, 0), WallFaces::anyWall).face, 0);
    EXPECT_NEAR(faces.distanceTo(Vector3(1.3, 0.1, 0.2), 1), 0.8, 1e-15);
    EXPECT_EQ(faces.distanceTo(Vector3(1.3, 0.1, 0.2), 7), std::numeric_limits<double>::infinity());
}

TEST(WallFaces, takesTheFaceOfSmallerCentreForAPointOnAnEdge)
{
    const WallFaces faces(mine(), 0.05, MPI_COMM_WORLD);
    for (int n = 1; n < 8; ++n) {
        const WallFaces::Place place = faces.find(Vector3(n * edge, 0.1, 0.01), 0);
        ASSERT_GE(place.face, 0);
        EXPECT_NEAR(faces.centreOf(place.face)[0], (n - 0.5) * edge, 1e-15);
    }
}

TEST(WallFaces, findsTheNearestOfTiltedFacesAtEveryPointAsALookAtAllOfThemDoes)
{
    // A cylinder of 24 strips, whose boxes overlap.
    constexpr double pi = 3.14159265358979323846;
    std::vector<WallFacePolygon> strips;
    for (int n = 0; n < 24 && rankOf() == 0; ++n) {
        const double a = 2 * pi * n / 24 + 0.1, b = 2 * pi * (n + 1) / 24 + 0.1;
        for (int level = 0; level < 4; ++level) {
            const double low = 0.3 * level, high = low + 0.3;
            strips.push_back({0,
                              {Vector3(std::cos(a), std::sin(a), low), Vector3(std::cos(b), std::sin(b), low),
                               Vector3(std::cos(b), std::sin(b), high), Vector3(std::cos(a), std::sin(a), high)}});
        }
    }
    const WallFaces faces(strips, 0.04, MPI_COMM_WORLD);
    int found = 0;
    for (int n = 0; n < 500; ++n) {
        const double angle = 0.37 * n, radius = 0.93 + 0.0002 * n, height = 1.2 * (n % 37) / 37.0;
        const Vector3 point(radius * std::cos(angle), radius * std::sin(angle), height);
        const double nearest = faces.distanceTo(point, 0);
        const WallFaces::Place place = faces.find(point, 0);
        EXPECT_EQ(place.face >= 0, nearest <= faces.reach()) << n;
        if (place.face >= 0) {
            ++found;
            EXPECT_NEAR(place.distance, nearest, 1e-9) << n;
        }
    }
    EXPECT_GT(found, 100);
    EXPECT_LT(found, 400);
}

TEST(WallFaces, findsTheNearestOfRectanglesAlongTheAxesInsideTheirSidesAndBeyondThem)
{
    // The three sides of a corner, four faces each.
    std::vector<WallFacePolygon> sides;
    for (int normal = 0; normal < 3 && rankOf() == ranksOf() - 1; ++normal) {
        const Vector3 a = Vector3::Unit((normal + 1) % 3), b = 0.7 * Vector3::Unit((normal + 2) % 3);
        for (int n = 0; n < 4; ++n) {
            const Vector3 low = (n % 2) * a + (n / 2) * b;
            sides.push_back({normal, {low, low + a, low + a + b, low + b}});
        }
    }
    const WallFaces faces(sides, 0.2, MPI_COMM_WORLD);
    int inside = 0, beyond = 0;
    for (int n = 0; n < 1000; ++n) {
        const Vector3 point(0.0137 * n - 2 * std::floor(0.00685 * n) - 0.1, 0.0291 * n - 2 * std::floor(0.01455 * n) - 0.1,
                            0.0413 * n - 2 * std::floor(0.02065 * n) - 0.1);
        for (const int wall : {WallFaces::anyWall, 0, 1, 2}) {
            const double nearest = faces.distanceTo(point, wall);
            const WallFaces::Place place = faces.find(point, wall);
            ASSERT_EQ(place.face >= 0, nearest <= faces.reach()) << n;
            if (place.face >= 0) {
                EXPECT_NEAR(place.distance, nearest, 1e-12) << n;
                (point.minCoeff() < 0 ? beyond : inside) += 1;
            }
        }
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(beyond, 100);
}

TEST(WallFaces, bringsEveryChargeOnceToTheRankThatCountsItsFace)
{
    WallFaces faces(mine(), 0.05, MPI_COMM_WORLD);
    // Every rank leaves 1 C, 2 C, ... on the faces of the lower strip, one after the other.
    std::vector<Index> at;
    std::vector<double> charges;
    for (int n = 0; n < 8; ++n) {
        at.push_back(faces.find(Vector3((n + 0.5) * edge, 0.1, 0), 0).face);
        charges.push_back(n + 1);
    }
    at.push_back(at.front());
    charges.push_back(-0.5);
    Scalars own;
    faces.collect(at, charges, own);
    const std::vector<WallFacePolygon> all = mine();
    ASSERT_EQ(own.size(), static_cast<Index>(all.size()));
    for (Index n = 0; n < own.size(); ++n) {
        const WallFacePolygon& face = all[static_cast<std::size_t>(n)];
        const int number = static_cast<int>(face.corners[0][0] / edge + 0.5);
        const double each = face.wall == 1 ? 0 : number + 1 - (number == 0 ? 0.5 : 0);
        EXPECT_EQ(own[n], ranksOf() * each);
    }
}

}  // namespace
}  // namespace him
