// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/particle_shares.hpp"

#include "tests/support/fake_gas_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace him {
namespace {

const Box box{Vector3(-1, 0, 2), Vector3(3, 2, 4)};
constexpr std::array<Index, 3> cells{8, 4, 4};  // cubes of 0.5
constexpr std::array<bool, 3> noPeriods{false, false, false};

/// Spheres of which each rank owns a part, wherever the cells are. Their sub-points stay in the box if `clear`.
DemParticles spheres(int count, bool clear)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    DemParticles all = emptyParticles(count);
    for (int n = 0; n < count; ++n) {
        all.radius[n] = 0.1 + 0.2 * share(random);
        const double margin = clear ? all.radius[n] : 0;
        for (int axis = 0; axis < 3; ++axis) {
            all.position(n, axis) = box.lower[axis] + margin + share(random) * (box.size()[axis] - 2 * margin);
        }
    }
    return dealt(all, MPI_COMM_WORLD);
}

double overRanks(double value)
{
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return value;
}

class Shares : public testing::TestWithParam<bool> {
protected:
    FakeGasMesh mesh{box, cells, MPI_COMM_WORLD};
    ParticleShares shares{mesh, MPI_COMM_WORLD, box, noPeriods, GetParam()};
};

TEST_P(Shares, keepTheSumOfWhatTheyLayOnCellsBesideWallsToo)
{
    const DemParticles particles = spheres(200, false);
    shares.locate(particles);
    EXPECT_EQ(overRanks(static_cast<double>(shares.rowsOutside())), 0);
    CellValues laid;
    shares.deposit<1>([&](Index row) { return std::array<double, 1>{std::pow(particles.radius[row], 3)}; }, laid);
    EXPECT_GE(laid.size() > 0 ? laid.minCoeff() : 0, 0);
    const double total = overRanks(particles.radius.cube().sum());
    EXPECT_NEAR(overRanks(laid.sum()), total, 1e-14 * total);
}

TEST_P(Shares, gatherWithTheWeightsByWhichTheyLay)
{
    // sum over rows of a gather(b) = sum over cells of deposit(a) b.
    const DemParticles particles = spheres(200, false);
    shares.locate(particles);
    CellValues values(mesh.cellCount(), 2), laid;
    for (Index cell = 0; cell < values.rows(); ++cell) {
        values(cell, 0) = std::pow(mesh.cellCentre(cell)[2], 3);
        values(cell, 1) = mesh.cellCentre(cell)[0] - 3 * mesh.cellCentre(cell)[1];
    }
    Eigen::ArrayXXd ofParticles(particles.size(), 2), gathered(particles.size(), 2);
    ofParticles << particles.radius, particles.radius.square();
    shares.deposit<2>([&](Index row) { return std::array<double, 2>{ofParticles(row, 0), ofParticles(row, 1)}; }, laid);
    shares.gather(values, [&](Index row, const double* means) { gathered.row(row) << means[0], means[1]; });
    for (int column = 0; column < 2; ++column) {
        const double ofRows = overRanks((ofParticles.col(column) * gathered.col(column)).sum());
        EXPECT_NEAR(overRanks((laid.col(column) * values.col(column)).sum()), ofRows, 1e-13 * std::fabs(ofRows));
    }
}

TEST_P(Shares, findALinearFieldAtTheCentreOfEveryParticle)
{
    const DemParticles particles = spheres(200, true);
    shares.locate(particles);
    Points found;
    shares.gather(
        particles,
        [this](Index cell, const Vector3& point) {
            EXPECT_EQ(mesh.findCell(point), cell) << "a point was not asked for in its cell";
            return Vector3(1 + point[0] - 3 * point[1], point[2], 7);
        },
        found);
    for (Index row = 0; row < particles.size(); ++row) {
        const auto at = particles.position.row(row);
        EXPECT_NEAR(found(row, 0), 1 + at[0] - 3 * at[1], 1e-13);
        EXPECT_NEAR(found(row, 1), at[2], 1e-13);
        EXPECT_NEAR(found(row, 2), 7, 1e-13);
    }
}

TEST_P(Shares, seekStrayParticlesOnePeriodAwayAndSayThePointsThere)
{
    ParticleShares periodic(mesh, MPI_COMM_WORLD, box, {true, false, false}, GetParam());
    DemParticles particles = spheres(50, true);
    const Scalars inside = particles.position.col(0);
    particles.position.col(0) += box.size()[0];
    periodic.locate(particles);
    EXPECT_EQ(periodic.rowsOutside(), 0);
    Points found;
    periodic.gather(
        particles, [](Index, const Vector3& point) { return point; }, found);
    for (Index row = 0; row < particles.size(); ++row) {
        EXPECT_NEAR(found(row, 0), inside[row], 1e-13);
    }
}

TEST_P(Shares, giveNothingOfParticlesOutside)
{
    DemParticles particles = spheres(8, true);
    particles.position.col(1) += 3;
    shares.locate(particles);
    EXPECT_EQ(shares.rowsOutside(), particles.size());
    CellValues laid;
    shares.deposit<1>([&](Index row) { return std::array<double, 1>{particles.radius[row]}; }, laid);
    EXPECT_EQ(laid.abs().sum(), 0);
    Index taken = 0;
    shares.gather(CellValues::Ones(mesh.cellCount(), 3), [&](Index, const double* means) {
        EXPECT_EQ(std::abs(means[0]) + std::abs(means[1]) + std::abs(means[2]), 0);
        ++taken;
    });
    EXPECT_EQ(taken, particles.size());
}

INSTANTIATE_TEST_SUITE_P(ByCentreAndBySubPoints, Shares, testing::Bool());

TEST(SubPoints, haveTheSecondMomentOfTheSphere)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    ParticleShares shares(mesh, MPI_COMM_WORLD, box, noPeriods, true);
    const DemParticles particles = spheres(40, true);
    shares.locate(particles);
    Points squares;
    shares.gather(
        particles, [](Index, const Vector3& point) { return point.cwiseProduct(point).eval(); }, squares);
    for (Index row = 0; row < particles.size(); ++row) {
        for (int axis = 0; axis < 3; ++axis) {
            const double expected = std::pow(particles.position(row, axis), 2) + std::pow(particles.radius[row], 2) / 5;
            EXPECT_NEAR(squares(row, axis), expected, 1e-13 * expected);
        }
    }
}

TEST(SubPoints, beyondAWallGiveTheirShareToTheOthers)
{
    // A centre 0.1 radius from the wall: one point on the axis and four on diagonals of 15 are beyond it.
    const FakeGasMesh mesh(box, {8, 1, 1}, MPI_COMM_WORLD);
    ParticleShares shares(mesh, MPI_COMM_WORLD, box, noPeriods, true);
    DemParticles particles = spheres(1, true);
    for (Index row = 0; row < particles.size(); ++row) {
        particles.radius[row] = 0.4;
        particles.position.row(row) << 1.25, 0.04, 3;
    }
    shares.locate(particles);
    Points inWallsDirection;
    shares.gather(
        particles, [](Index, const Vector3& point) { return point; }, inWallsDirection);
    for (Index row = 0; row < particles.size(); ++row) {
        // What remains: centre, five on the axes, four on diagonals at +0.802/sqrt(3).
        const double distance = 0.4 * std::sqrt(9.0 / 14);
        EXPECT_NEAR(inWallsDirection(row, 1), 0.04 + distance * (1 + 4 / std::sqrt(3.0)) / 10, 1e-13);
    }
}

}  // namespace
}  // namespace him
