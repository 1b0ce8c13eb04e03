// SPDX-License-Identifier: GPL-3.0-or-later
// p3m beside an insulating wall in the middle of a grounded box: faces with charges of their own, particles that touch them on
// both sides. The reference is the exact field of the box with the faces as many points.
#include "dem_coupling/field_method.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/reference/grounded_box.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/packings.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace him {

namespace {

constexpr std::array<bool, 3> open{false, false, false};
constexpr double unit = 4 * pi * epsilon0;  ///< charge whose field at 1 m is 1 V/m
constexpr double length = 24, cell = 2, middle = 12, wallHeight = 18;

/// A number in -1..1 that depends on the place alone.
double noise(const Vector3& place)
{
    const double s = std::sin(12.9898 * place[1] + 78.233 * place[2] + 1) * 43758.5453;
    return 2 * (s - std::floor(s)) - 1;
}

/// Charge per area of a wall that is charged unevenly from face to face.
double uneven(const Vector3& place)
{
    return unit * (0.3 + 0.4 * noise(place));
}

/// Spheres of diameter 1, a good share of them touching the wall.
DemParticles besideTheWall()
{
    const Packing packing = makePacking(Scene::dilute, length, Signs::random, 3);
    std::vector<Vector3> kept;
    std::vector<double> charges;
    for (Index row = 0; row < packing.position.rows(); ++row) {
        Vector3 place = packing.position.row(row).matrix().transpose();
        if (std::abs(place[0] - middle) < 3) {
            place[0] = middle + (place[0] < middle ? -0.5 : 0.5);
        }
        bool free = true;
        for (const Vector3& other : kept) {
            free = free && (other - place).norm() >= 1;
        }
        if (free) {
            kept.push_back(place);
            charges.push_back(packing.charge[row] * unit);
        }
    }
    DemParticles particles = emptyParticles(static_cast<int>(kept.size()));
    for (std::size_t n = 0; n < kept.size(); ++n) {
        particles.position.row(static_cast<Index>(n)) = kept[n].transpose().array();
        particles.charge[static_cast<Index>(n)] = charges[n];
    }
    return particles;
}

/// Exact field at some points of particles and of a wall whose faces are `fine` x `fine` points.
Points exactField(const DemParticles& all, const Points& targets, const std::vector<Index>& ownRow,
                  const std::function<double(const Vector3&)>& density, int fine)
{
    const int rows = static_cast<int>(wallHeight / cell), columns = static_cast<int>(length / cell);
    const Index count = all.size() + static_cast<Index>(rows) * columns * fine * fine;
    Points position(count, 3);
    Scalars charge(count);
    position.topRows(all.size()) = all.position;
    charge.head(all.size()) = all.charge;
    Index at = all.size();
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double q = density({middle, (i + 0.5) * cell, (j + 0.5) * cell}) * cell * cell / (fine * fine);
            for (int n = 0; n < fine * fine; ++n) {
                position.row(at) << middle, (i + (n % fine + 0.5) / fine) * cell, (j + (n / fine + 0.5) / fine) * cell;
                charge[at++] = q;
            }
        }
    }
    Points field;
    Scalars potential;
    const Box box{Vector3::Zero(), Vector3::Constant(length)};
    GroundedBox reference(box, epsilon0);
    reference.setTolerance(1e-6);
    reference.computeAt(position, charge, targets, ownRow, field, potential);
    return field;
}

Points p3mField(const DemParticles& mine, const P3mSettings& p3m, const std::function<double(const Vector3&)>& density,
                Scalars* potential = nullptr)
{
    const Box box{Vector3::Zero(), Vector3::Constant(length)};
    const Index cells = std::lround(length / cell);
    BoxMesh mesh(box, {cells, cells, cells}, epsilon0, MPI_COMM_WORLD);
    mesh.chargeWall(std::lround(middle / cell) - 1, wallHeight, density);
    FieldSettings settings;
    settings.method = "p3m";
    settings.permittivity = epsilon0;
    settings.p3m = p3m;
    PhaseTimes times;
    ParticleField result;
    FieldMethod::create(settings, &mesh, box, open, MPI_COMM_WORLD, times)->compute(mine, result);
    if (potential) {
        *potential = result.potential;
    }
    return result.field;
}

P3mSettings cubic()
{
    return {};
}

P3mSettings quartic()
{
    P3mSettings settings;
    settings.cloudCells = 3;
    settings.gather = PolynomialOrder::quartic;
    settings.deferredCorrection = true;
    return settings;
}

}  // namespace

TEST(ChargedWallsInP3m, actOnParticlesThatTouchThemAsWellAsParticlesDo)
{
    const DemParticles all = besideTheWall();
    std::vector<Index> ownRow(static_cast<std::size_t>(all.size()));
    Index touching = 0;
    for (Index row = 0; row < all.size(); ++row) {
        ownRow[static_cast<std::size_t>(row)] = row;
        touching += std::abs(std::abs(all.position(row, 0) - middle) - 0.5) < 1e-9;
    }
    EXPECT_GT(touching, 40);
    const Points exact = exactField(all, all.position, ownRow, uneven, 12);
    const DemParticles mine = dealt(all, MPI_COMM_WORLD);
    const auto errors = [&](const P3mSettings& settings, bool atWall) {
        const auto fields = gatherByTag(mine.tag, p3mField(mine, settings, uneven), MPI_COMM_WORLD);
        double error = 0, size = 0;
        for (Index row = 0; row < all.size(); ++row) {
            if (!atWall || std::abs(all.position(row, 0) - middle) < 1) {
                const Vector3 right = exact.row(row).matrix().transpose();
                error += (fields.at(all.tag[static_cast<std::size_t>(row)]) - right).squaredNorm();
                size += right.squaredNorm();
            }
        }
        return std::sqrt(error / size);
    };
    for (const bool atWall : {false, true}) {
        const double coarse = errors(cubic(), atWall);
        const double fine = errors(quartic(), atWall);
        std::printf("%s: error %.2g at R = 2 h cubic, %.2g at 3 h quartic\n", atWall ? "touching the wall" : "all",
                    coarse, fine);
        EXPECT_LT(coarse, 0.04);
        EXPECT_LT(fine, 0.010);
    }
}

TEST(ChargedWallsInP3m, haveAFieldThatStaysFiniteAndRightHoweverCloseAParticleComes)
{
    const auto even = [](const Vector3&) { return 0.3 * unit; };
    DemParticles probes = emptyParticles(8);
    const double heights[] = {1e-3, 0.02, 0.1, 0.25, -1e-3, -0.1, -0.25, 1.7};
    for (Index row = 0; row < 8; ++row) {
        probes.position.row(row) << middle + heights[row], 11.3, 7.1;
    }
    const Points exact = exactField(emptyParticles(0), probes.position, std::vector<Index>(8, -1), even, 100);
    const DemParticles mine = dealt(probes, MPI_COMM_WORLD);
    for (const auto& [settings, bound] : {std::make_pair(cubic(), 0.04), std::make_pair(quartic(), 0.010)}) {
        const auto fields = gatherByTag(mine.tag, p3mField(mine, settings, even), MPI_COMM_WORLD);
        for (Index row = 0; row < 8; ++row) {
            // Nearer than this the points of the reference show.
            if (std::abs(heights[row]) > 0.05) {
                const Vector3 right = exact.row(row).matrix().transpose();
                EXPECT_LT((fields.at(static_cast<int>(row) + 1) - right).norm(), bound * right.norm()) << heights[row];
            }
        }
        const double jump = 0.3 * unit / epsilon0;
        EXPECT_NEAR(fields.at(1)[0] - fields.at(5)[0], jump, bound * jump);  // polynomials of two cells meet here
    }
}

}  // namespace him
