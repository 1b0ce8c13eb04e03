// SPDX-License-Identifier: GPL-3.0-or-later
// What the methods leave of a sphere's response to its own charge when it touches a wall: an isolated sphere of charge q
// stops at q_sat (1 + remainder/own surface field), because Gamma is calibrated without that response.
#include "dem_coupling/field_method.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace him {

namespace {

constexpr double length = 0.06;     // the shaker's cube [m]
constexpr double radius = 6.35e-3;  // of its PTFE spheres [m]
constexpr double charge = -3.441e-9;
constexpr std::array<bool, 3> open{false, false, false};

/// Part of the field along the normal of the touched wall that charging would see, in units of the sphere's surface field.
double remainder(const FieldSettings& asked, const Vector3& place, const Vector3& normal, Index cells = 20)
{
    const Box box{Vector3::Zero(), Vector3::Constant(length)};
    BoxMesh mesh(box, {cells, cells, cells}, epsilon0, MPI_COMM_SELF);
    PhaseTimes times;
    FieldSettings settings = asked;
    settings.permittivity = epsilon0;
    if (settings.method == "him") {
        settings.nearCutoff = mesh.largestCellDiagonal();
    }
    const auto method = FieldMethod::create(settings, &mesh, box, open, MPI_COMM_SELF, times);
    DemParticles particle = emptyParticles(1);
    particle.position.row(0) = place.transpose().array();
    particle.charge[0] = charge;
    particle.radius[0] = radius;
    ParticleField result;
    method->compute(particle, result);
    Points others = result.field;
    if (result.ownResponse.rows() == 1) {
        others -= result.ownResponse;
    }
    return others.row(0).matrix().dot(normal.transpose()) / surfaceField(charge, radius, epsilon0);
}

/// Touching the floor in the middle, off the middle, near an edge and in a corner.
const std::array<Vector3, 4> places{Vector3(0.03, 0.03, radius), Vector3(0.0213, 0.0377, radius),
                                    Vector3(0.0071, 0.031, radius), Vector3(radius, radius, radius)};
const Vector3 down(0, 0, -1);

TEST(IsolatedSphere, stopsAtSaturationWithTheImagesOfPairwiseSum)
{
    FieldSettings settings;
    settings.method = "pairwiseSum";
    settings.pairwiseSum.images = true;
    for (const auto& [axis, height] : {std::pair{0, 0.0}, std::pair{1, 0.0}, std::pair{2, 0.0}, std::pair{2, length}}) {
        ImageWall wall;
        wall.point[axis] = height;
        wall.normal = Vector3::Unit(axis) * (height > 0 ? 1 : -1);
        settings.pairwiseSum.imageWalls.push_back(wall);
    }
    for (const Vector3& place : places) {
        EXPECT_NEAR(remainder(settings, place, down), 0, 1e-14);
    }
}

TEST(IsolatedSphere, stopsAtSaturationWithTheResponseTableOfHim)
{
    FieldSettings settings;
    settings.method = "him";
    for (const OwnCellResponse response : {OwnCellResponse::forceOnly, OwnCellResponse::remove}) {
        settings.him.ownCellResponse = response;
        for (const Vector3& place : places) {
            EXPECT_NEAR(remainder(settings, place, down), 0, 1e-12);
        }
    }
}

TEST(IsolatedSphere, isHeldBackByTheWallsWhenHimKeepsItsOwnResponse)
{
    // Without the table the mesh's image of the sphere opposes charging; that is what the table is for.
    FieldSettings settings;
    settings.method = "him";
    double largest = 0;
    for (const Vector3& place : places) {
        largest = std::max(largest, std::fabs(remainder(settings, place, down)));
    }
    EXPECT_GT(largest, 0.01);
}

TEST(IsolatedSphere, stopsAtSaturationWithP3mInCellsSmallerThanTheSphere)
{
    // Without its table 1 to 7 % of the surface field would be left at a cloud radius of 2 cells.
    FieldSettings settings;
    settings.method = "p3m";
    for (const double cloudCells : {2.0, 3.0}) {
        settings.p3m.cloudCells = cloudCells;
        for (const Index cells : {8, 12, 20}) {
            for (const Vector3& place : places) {
                EXPECT_NEAR(remainder(settings, place, down, cells), 0, 1e-5)
                    << place.transpose() << ", " << cells << " cells";
            }
        }
    }
}

TEST(IsolatedSphere, stopsWithinHalfAPerCentOfSaturationWithP3mInCellsOfItsSize)
{
    FieldSettings settings;
    settings.method = "p3m";
    settings.permittivity = epsilon0;
    constexpr Index cells = 16;
    for (const double cellsPerRadius : {0.5, 0.4, 0.25}) {
        const double h = radius / cellsPerRadius;
        const Box box{Vector3::Zero(), Vector3::Constant(cells * h)};
        BoxMesh mesh(box, {cells, cells, cells}, epsilon0, MPI_COMM_SELF);
        for (const bool direct : {true, false}) {
            mesh.direct = direct;
            PhaseTimes times;
            const auto method = FieldMethod::create(settings, &mesh, box, open, MPI_COMM_SELF, times);
            for (int n = 0; n < 40; ++n) {
                DemParticles particle = emptyParticles(1);
                particle.position.row(0) << (2.3 + 0.27 * n) * h, (2.1 + 0.293 * n) * h, radius;
                if (n % 4 == 3) {
                    particle.position(0, 0) = radius;
                }
                particle.charge[0] = charge;
                particle.radius[0] = radius;
                ParticleField result;
                method->compute(particle, result);
                EXPECT_NEAR((result.field - result.ownResponse)(0, 2) / surfaceField(charge, radius, epsilon0), 0, 5e-3)
                    << particle.position << ", h/r " << 1 / cellsPerRadius;
            }
        }
    }
}

TEST(IsolatedSphere, stopsWithinWhatTheLogSaysWhereTheMeshIsTooLargeForATable)
{
    // 64000 cells of an eighth of the sphere.
    FieldSettings settings;
    settings.method = "p3m";
    double largest = 0;
    for (const Vector3& place : places) {
        settings.p3m.cloudCells = 4;
        EXPECT_NEAR(remainder(settings, place, down, 40), 0, 5e-3) << place.transpose();
        settings.p3m.cloudCells = 2;
        largest = std::max(largest, std::fabs(remainder(settings, place, down, 40)));
    }
    EXPECT_LT(largest, 0.12);
    EXPECT_GT(largest, 0.03);
}

}  // namespace

}  // namespace him
