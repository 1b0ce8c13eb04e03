// SPDX-License-Identifier: GPL-3.0-or-later
// The field of the others where a sphere touches a wall, as `wallField atContactPoint` asks for it, against the exact field of a grounded
// box in which the sphere has no charge and a probe without charge stands at the contact point.
#include "dem_coupling/accuracy_choice.hpp"
#include "dem_coupling/field_method.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"
#include "electrostatics/reference/grounded_box.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace him {

namespace {

constexpr double h = 1e-3;  // cells of one particle diameter [m]
constexpr Index cells = 16;
constexpr double radius = 0.5 * h;
constexpr double unit = 1e-12;  // [C]
const Box box{Vector3::Zero(), Vector3::Constant(cells* h)};
constexpr std::array<bool, 3> open{false, false, false};
const double surface = surfaceField(unit, radius, epsilon0);

constexpr int count = 6;
/// The first and the fourth touch walls; others touch them.
std::array<Vector3, count> places(double along)
{
    return {Vector3(6.3 * h + along, 7.1 * h, radius),
            Vector3(6.3 * h + along + 0.8 * h, 7.1 * h, radius + 0.6 * h),
            Vector3(6.3 * h + along, 8.4 * h, 1.3 * h),
            Vector3(radius, 9.2 * h + along, 5.2 * h),
            Vector3(radius + 0.6 * h, 9.2 * h + along, 6 * h),
            Vector3(11 * h, 3.3 * h, 12.1 * h)};
}

DemParticles scene(double along)
{
    DemParticles particles = emptyParticles(count);
    for (Index row = 0; row < count; ++row) {
        const auto n = static_cast<std::size_t>(row);
        particles.position.row(row) = places(along)[n].transpose().array();
        particles.charge[row] = unit * (n == 5 ? -0.7 : 1.0);
        particles.radius[row] = radius;
    }
    return dealt(particles, MPI_COMM_WORLD);
}

struct Touch {
    int tag;
    Vector3 normal;
};
const std::array<Touch, 2> touches{Touch{1, -Vector3::UnitZ()}, Touch{4, -Vector3::UnitX()}};

/// The method's field at the contact points of all touches, asked for by the rank that has the particle, on every rank.
std::array<Vector3, 2> found(FieldMethod& method, double along)
{
    PointField* points = method.pointField();
    const DemParticles particles = scene(along);
    ParticleField result;
    method.compute(particles, result);
    std::vector<int> tags;
    std::vector<Vector3> asked;
    for (const Touch& touch : touches) {
        for (Index row = 0; row < particles.size(); ++row) {
            if (particles.tag[static_cast<std::size_t>(row)] == touch.tag) {
                asked.push_back(Vector3(particles.position.row(row).matrix().transpose()) + radius * touch.normal);
                tags.push_back(touch.tag);
            }
        }
    }
    Points where(static_cast<Index>(asked.size()), 3);
    for (Index n = 0; n < where.rows(); ++n) {
        where.row(n) = asked[static_cast<std::size_t>(n)].transpose().array();
    }
    Points field;
    points->fieldOfOthers(particles, where, tags, field);
    std::array<Vector3, 2> all{Vector3::Zero(), Vector3::Zero()};
    for (std::size_t n = 0; n < tags.size(); ++n) {
        all[tags[n] == touches[0].tag ? 0 : 1] = field.row(static_cast<Index>(n)).matrix().transpose();
    }
    for (Vector3& one : all) {
        MPI_Allreduce(MPI_IN_PLACE, one.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    }
    return all;
}

/// Exact, the touching particle without charge, a hair above the wall.
Vector3 exact(double along, const Touch& touch)
{
    Points position(count, 3);
    Scalars charge(count);
    for (int n = 0; n < count; ++n) {
        position.row(n) = places(along)[static_cast<std::size_t>(n)].transpose().array();
        charge[n] = n + 1 == touch.tag ? 0 : unit * (n == 5 ? -0.7 : 1.0);
    }
    Points point(1, 3);
    point.row(0) = position.row(touch.tag - 1) + ((radius - 1e-6 * h) * touch.normal).transpose().array();
    Points field;
    Scalars potential;
    GroundedBox(box, epsilon0).computeAt(position, charge, point, {-1}, field, potential);
    return field.row(0).matrix().transpose();
}

FieldSettings settingsOf(const std::string& method)
{
    FieldSettings settings;
    settings.method = method;
    settings.permittivity = epsilon0;
    settings.pairwiseSum.images = true;
    settings.pairwiseSum.imageWalls = wallsOf(box);
    return settings;
}

}  // namespace

TEST(PointField, ofThePairSumIsThatOfTheOthersAndTheirImages)
{
    PhaseTimes times;
    const auto method = FieldMethod::create(settingsOf("pairwiseSum"), nullptr, box, open, MPI_COMM_WORLD, times);
    const auto field = found(*method, 0);
    for (std::size_t n = 0; n < touches.size(); ++n) {
        // Images of images between parallel walls, 16 diameters apart, are left out.
        EXPECT_LT((field[n] - exact(0, touches[n])).norm(), 5e-3 * surface);
        EXPECT_GT(field[n].norm(), 0.2 * surface);
        EXPECT_LT(field[n].cross(touches[n].normal).norm(), 5e-3 * surface)
            << "a conductor has no field along its surface";
    }
}

TEST(PointField, ofP3mIsWithinItsErrorAtCentres)
{
    for (const bool wide : {false, true}) {
        for (const bool direct : {true, false}) {
            BoxMesh mesh(box, {cells, cells, cells}, epsilon0, MPI_COMM_WORLD);
            mesh.direct = direct;
            PhaseTimes times;
            FieldSettings settings = settingsOf("p3m");
            if (wide) {
                settings.p3m.cloudCells = 3;
                settings.p3m.gather = PolynomialOrder::quartic;
                settings.p3m.deferredCorrection = true;
            }
            const auto method = FieldMethod::create(settings, &mesh, box, open, MPI_COMM_WORLD, times);
            for (const double along : {0.0, 0.23 * h, 0.57 * h}) {
                const auto field = found(*method, along);
                for (std::size_t n = 0; n < touches.size(); ++n) {
                    const Vector3 error = field[n] - exact(along, touches[n]);
                    EXPECT_LT(error.norm(), (wide ? 0.004 : 0.04) * surface);
                }
            }
        }
    }
}

TEST(PointField, ofP3mIsRefusedInCellsSmallerThanParticles)
{
    BoxMesh mesh(box, {cells, cells, cells}, epsilon0, MPI_COMM_WORLD);
    PhaseTimes times;
    const auto method = FieldMethod::create(settingsOf("p3m"), &mesh, box, open, MPI_COMM_WORLD, times);
    method->pointField();
    DemParticles particles = scene(0);
    particles.radius *= 2;
    ParticleField result;
    try {
        method->compute(particles, result);
        FAIL();
    } catch (const std::runtime_error& refusal) {
        EXPECT_NE(std::string(refusal.what()).find("cells are smaller than particles"), std::string::npos);
    }
}

}  // namespace him
