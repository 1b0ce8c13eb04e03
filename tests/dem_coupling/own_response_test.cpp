// SPDX-License-Identifier: GPL-3.0-or-later
// What a particle's field holds of its own charge, as p3m hands it over in cells that are smaller than particles: all of it, wherever
// the particle stands and whoever else is there.
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

constexpr double edge = 0.06;    // of the box [m]
constexpr double radius = 4e-3;  // cells of 7.5 mm, smaller than a particle
constexpr double unit = 1e-9;    // [C]
constexpr int count = 3;

const Box box{Vector3::Zero(), Vector3::Constant(edge)};

/// The particles of this rank of a small crowd, one of them at a wall; `charge` is that of the first one.
DemParticles crowd(double charge, double size = radius)
{
    const std::array<Vector3, count> places{Vector3(0.0291, 0.0377, radius), Vector3(0.0321, 0.0362, 0.0121),
                                            Vector3(0.0303, 0.0303, 0.0108)};
    DemParticles particles = emptyParticles(count);
    for (Index row = 0; row < count; ++row) {
        const auto n = static_cast<std::size_t>(row);
        particles.position.row(row) = places[n].transpose().array();
        particles.charge[row] = n == 0 ? charge : unit * (n % 2 ? -1.0 : 0.7);
        particles.radius[row] = size;
    }
    return dealt(particles, MPI_COMM_WORLD);
}

struct Scene {
    BoxMesh mesh;
    PhaseTimes times;
    std::unique_ptr<FieldMethod> method;

    Scene(const P3mSettings& p3m, bool direct, const std::array<bool, 3>& periodic = {false, false, false})
        : mesh(box, {8, 8, 8}, epsilon0, MPI_COMM_WORLD, periodic)
    {
        mesh.direct = direct;
        FieldSettings settings;
        settings.method = "p3m";
        settings.permittivity = epsilon0;
        settings.p3m = p3m;
        method = FieldMethod::create(settings, &mesh, box, periodic, MPI_COMM_WORLD, times);
    }

    ParticleField field(const DemParticles& particles)
    {
        ParticleField result;
        method->compute(particles, result);
        return result;
    }
};

/// Field of the first particle [V/m] less its own response, on every rank.
Vector3 othersAtFirst(const ParticleField& result, const DemParticles& particles)
{
    Vector3 field = Vector3::Zero();
    for (Index row = 0; row < particles.size(); ++row) {
        if (particles.tag[static_cast<std::size_t>(row)] == 1) {
            field = (result.field - result.ownResponse).row(row).matrix().transpose();
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, field.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return field;
}

const double surface = surfaceField(unit, radius, epsilon0);

/// Settings of p3m, and whether the mesh solves directly; on several ranks one of them, since every solve is a wait for all.
std::vector<std::pair<P3mSettings, bool>> variants()
{
    P3mSettings corrected;
    corrected.deferredCorrection = true;
    P3mSettings wide;
    wide.cloudCells = 3;
    wide.gather = PolynomialOrder::quartic;
    P3mSettings selfTerm;
    selfTerm.selfTerm = true;
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (ranks > 1) {
        return {{corrected, false}};
    }
    return {{P3mSettings(), true}, {corrected, false}, {wide, false}, {selfTerm, true}};
}

}  // namespace

TEST(OwnResponse, leavesTheFieldThatTheOthersMakeWhereTheParticleIsNotCharged)
{
    for (const auto& [variant, direct] : variants()) {
        Scene scene(variant, direct);
        const DemParticles without = crowd(0);
        const Vector3 expected = othersAtFirst(scene.field(without), without);
        const DemParticles with = crowd(5 * unit);
        EXPECT_LT((othersAtFirst(scene.field(with), with) - expected).norm(), 1e-4 * surface);
    }
}

TEST(OwnResponse, isTakenOutBetweenPeriodicSidesToo)
{
    Scene scene(P3mSettings(), false, {true, true, false});
    const DemParticles without = crowd(0);
    const Vector3 expected = othersAtFirst(scene.field(without), without);
    const DemParticles with = crowd(5 * unit);
    EXPECT_LT((othersAtFirst(scene.field(with), with) - expected).norm(), 1e-4 * surface);
}

TEST(OwnResponse, isFoundForCellsThatAreVisitedLater)
{
    Scene scene(P3mSettings(), true);
    DemParticles particles = crowd(5 * unit);
    scene.field(particles);
    DemParticles without = crowd(0);
    for (const double step : {0.013}) {
        for (DemParticles* some : {&particles, &without}) {
            some->position.col(1) = some->position.col(1) * 0.8 + step;
        }
        const Vector3 expected = othersAtFirst(scene.field(without), without);
        EXPECT_LT((othersAtFirst(scene.field(particles), particles) - expected).norm(), 1e-4 * surface);
    }
}

TEST(OwnResponse, changesNothingInTheFieldItself)
{
    const DemParticles particles = crowd(5 * unit);
    DemParticles small = crowd(5 * unit, 1e-3);  // no table for these
    Scene scene(P3mSettings(), true);
    const Points alone = scene.field(small).field;
    const Points field = scene.field(particles).field;
    EXPECT_LT((field - alone).matrix().norm(), 1e-12 * (1 + alone.matrix().norm()));
}

TEST(OwnResponse, costsNoSolveWhereNobodyAsksForIt)
{
    Scene scene(P3mSettings(), true);
    FieldSettings settings;
    settings.method = "p3m";
    settings.permittivity = epsilon0;
    settings.ownResponse = false;
    const auto method =
        FieldMethod::create(settings, &scene.mesh, box, {false, false, false}, MPI_COMM_WORLD, scene.times);
    const DemParticles particles = crowd(unit);
    ParticleField result;
    method->compute(particles, result);
    EXPECT_EQ(result.ownResponse.rows(), 0);
    EXPECT_EQ(method->ownResponseText(), "");
}

}  // namespace him
