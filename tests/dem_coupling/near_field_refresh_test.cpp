// SPDX-License-Identifier: GPL-3.0-or-later
// The short-range field that lets a held field follow the particles between two updates.
#include "dem_coupling/field_method.hpp"
#include "dem_coupling/near_field_refresh.hpp"
#include "electrostatics/constants.hpp"
#include "tests/support/collective_throw.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

constexpr std::array<bool, 3> open{false, false, false};
const MPI_Comm world = MPI_COMM_WORLD;
constexpr double d = 1e-3;                     // diameter [m]
constexpr double reach = 4e-3;                 // [m]
const double coulomb = 1 / (4 * pi * epsilon0);  // [m/F]
const Box box{Vector3::Zero(), Vector3::Constant(0.016)};

ImageWall floorPlane()
{
    ImageWall wall;
    wall.normal = -Vector3::UnitZ();
    return wall;
}

struct NearFields {
    std::map<int, Vector3> all, own;
};

NearFields nearFieldsOf(const DemParticles& all, const std::vector<ImageWall>& planes,
                        const std::array<bool, 3>& periodic = open)
{
    PhaseTimes times;
    NearFieldRefresh near(reach, epsilon0, planes, box, periodic, world, times);
    const DemParticles mine = dealt(all, world);
    Points field, own;
    near.compute(mine, field, own);
    NearFields found;
    found.all = gatherByTag(mine.tag, field, world);
    if (!planes.empty()) {
        found.own = gatherByTag(mine.tag, own, world);
    }
    return found;
}

/// Field at x of a charge at y, less that of its cloud [V/m].
Vector3 shortRange(const Vector3& x, const Vector3& y, double charge)
{
    const ChargeCloud cloud(reach, 2);
    const Vector3 r = x - y;
    return r.norm() < reach ? Vector3(coulomb * charge * cloud.shortRangeFieldCoefficient(r.norm()) * r) : Vector3::Zero();
}

DemParticles crowd(std::uint32_t seed = 3)
{
    Box inside = box;
    inside.lower.array() += d / 2;
    inside.upper.array() -= d / 2;
    return randomParticles(200, inside, d, 1e-12, Charges::random, seed);
}

TEST(NearFieldRefresh, isTheDoubleLoopOverChargesAndImagesOnAnyNumberOfRanks)
{
    const DemParticles all = crowd();
    const NearFields found = nearFieldsOf(all, {floorPlane()});
    for (Index i = 0; i < all.size(); ++i) {
        const Vector3 x = all.position.row(i).matrix().transpose();
        Vector3 sum = Vector3::Zero(), own = Vector3::Zero();
        for (Index j = 0; j < all.size(); ++j) {
            const Vector3 y = all.position.row(j).matrix().transpose();
            const Vector3 image(y.x(), y.y(), -y.z());
            sum += shortRange(x, image, -all.charge[j]);
            if (j == i) {
                own = shortRange(x, image, -all.charge[j]);
            } else {
                sum += shortRange(x, y, all.charge[j]);
            }
        }
        const int tag = all.tag[static_cast<std::size_t>(i)];
        const double scale = coulomb * 1e-12 / (d * d);
        EXPECT_LT((found.all.at(tag) - sum).norm(), 1e-11 * scale) << "tag " << tag;
        EXPECT_LT((found.own.at(tag) - own).norm(), 1e-11 * scale) << "tag " << tag;
    }
}

TEST(NearFieldRefresh, ofACornerHasSevenImages)
{
    std::vector<ImageWall> planes(3);
    for (int axis = 0; axis < 3; ++axis) {
        planes[static_cast<std::size_t>(axis)].normal = -Vector3::Unit(axis);
    }
    DemParticles one = emptyParticles(1);
    one.position.row(0) << 0.6e-3, 0.8e-3, 0.5e-3;
    one.charge << 3e-12;
    const NearFields found = nearFieldsOf(one, planes);
    const Vector3 x = one.position.row(0).matrix().transpose();
    Vector3 sum = Vector3::Zero();
    for (int mirrored = 1; mirrored < 8; ++mirrored) {
        Vector3 image = x;
        double sign = 1;
        for (int axis = 0; axis < 3; ++axis) {
            if (mirrored >> axis & 1) {
                image[axis] = -image[axis];
                sign = -sign;
            }
        }
        sum += shortRange(x, image, sign * one.charge[0]);
    }
    EXPECT_LT((found.all.at(1) - sum).norm(), 1e-12 * sum.norm());
    EXPECT_LT((found.own.at(1) - sum).norm(), 1e-12 * sum.norm());
}

TEST(NearFieldRefresh, reachesAcrossPeriodicFaces)
{
    DemParticles pair = emptyParticles(2);
    pair.position.row(0) << 0.5e-3, 8e-3, 8e-3;
    pair.position.row(1) << 15e-3, 8e-3, 8e-3;
    pair.charge << 1e-12, 2e-12;
    const NearFields found = nearFieldsOf(pair, {}, {true, false, false});
    EXPECT_LT((found.all.at(1) - shortRange(Vector3(0.5e-3, 0, 0), Vector3(-1e-3, 0, 0), 2e-12)).norm(),
              1e-12 * found.all.at(1).norm());
}

TEST(NearFieldRefresh, letsAHeldFieldFollowParticlesThatMove)
{
    FieldSettings settings;
    settings.method = "pairwiseSum";
    settings.permittivity = epsilon0;
    settings.pairwiseSum.images = true;
    settings.pairwiseSum.imageWalls = {floorPlane()};
    PhaseTimes times;
    const auto method = FieldMethod::create(settings, nullptr, box, open, world, times);
    const auto fieldOf = [&](const DemParticles& all) {
        const DemParticles mine = dealt(all, world);
        ParticleField result;
        method->compute(mine, result);
        return gatherByTag(mine.tag, result.field, world);
    };
    const DemParticles before = crowd();
    DemParticles after = before;
    for (Index row = 0; row < after.size(); ++row) {
        // A tenth of a diameter, each its own way.
        const double angle = 1.7 * static_cast<double>(row);
        after.position.row(row) += 0.1 * d * Eigen::Array3d(std::cos(angle), std::sin(angle) * std::cos(2 * angle),
                                                            std::sin(angle) * std::sin(2 * angle)).transpose();
    }
    const auto held = fieldOf(before);
    const auto exact = fieldOf(after);
    const auto nearBefore = nearFieldsOf(before, {floorPlane()}).all;
    const auto nearAfter = nearFieldsOf(after, {floorPlane()}).all;
    double heldError = 0, followingError = 0;
    for (const auto& [tag, field] : exact) {
        heldError += (held.at(tag) - field).squaredNorm();
        followingError += (held.at(tag) - nearBefore.at(tag) + nearAfter.at(tag) - field).squaredNorm();
    }
    EXPECT_LT(followingError, heldError / (5 * 5));
}

TEST(NearFieldRefresh, namesTwoParticlesInOnePlace)
{
    DemParticles twice = crowd();
    twice.position.row(1) = twice.position.row(0);
    PhaseTimes times;
    NearFieldRefresh near(reach, epsilon0, {}, box, open, world, times);
    const DemParticles mine = dealt(twice, world);
    Points field, own;
    expectContains(textThrownOnAllRanks(world, [&] { near.compute(mine, field, own); }), "are at the same position");
}

}  // namespace
}  // namespace him
