// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/particle_halo.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace him {
namespace {

const Box box{Vector3(-1, 2, 0), Vector3(1, 3.5, 3)};
const Vector3 centreOffset(0.01, -0.02, 0.03);  // cell centre minus position, the same for every particle

ChargedPoints ownPoints(const DemParticles& mine)
{
    ChargedPoints points;
    points.position = mine.position;
    points.charge = mine.charge;
    points.cellCentre = mine.position.rowwise() + centreOffset.transpose().array();
    return points;
}

using Source = std::array<double, 2>;  // distance, charge

/// Distance and charge of every source within the cutoff of a target.
std::vector<Source> sourcesFromHalo(const ChargedPoints& points, Index target, double cutoff)
{
    std::vector<Source> found;
    for (Index row = 0; row < points.position.rows(); ++row) {
        const double distance = std::sqrt((points.position.row(row) - points.position.row(target)).square().sum());
        if (row != target && distance <= cutoff) {
            found.push_back({distance, points.charge[row]});
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<Source> sourcesByBruteForce(const DemParticles& all, int tag, double cutoff, const std::array<bool, 3>& periodic)
{
    std::vector<Source> found;
    const Vector3 target = all.position.row(tag - 1).matrix().transpose();
    const auto range = [&](std::size_t axis) { return periodic[axis] ? 3 : 0; };
    for (int i = -range(0); i <= range(0); ++i) {
        for (int j = -range(1); j <= range(1); ++j) {
            for (int k = -range(2); k <= range(2); ++k) {
                const Vector3 shift = Vector3(i, j, k).cwiseProduct(box.size());
                for (Index row = 0; row < all.size(); ++row) {
                    const double distance = (all.position.row(row).matrix().transpose() + shift - target).norm();
                    if ((row != tag - 1 || i != 0 || j != 0 || k != 0) && distance <= cutoff) {
                        found.push_back({distance, all.charge[row]});
                    }
                }
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

void expectHaloEqualsBruteForce(double cutoff, const std::array<bool, 3>& periodic, std::uint32_t seed)
{
    const DemParticles all = randomParticles(120, box, 0.02, 1.0, Charges::random, seed);
    const DemParticles mine = dealt(all, MPI_COMM_WORLD);
    ParticleHalo halo(cutoff, box, periodic, MPI_COMM_WORLD);
    ChargedPoints points = ownPoints(mine);
    halo.extend(points);

    ASSERT_EQ(points.targets, mine.size());
    for (Index target = 0; target < points.targets; ++target) {
        const auto expected = sourcesByBruteForce(all, mine.tag[static_cast<std::size_t>(target)], cutoff, periodic);
        const auto found = sourcesFromHalo(points, target, cutoff);
        ASSERT_EQ(found.size(), expected.size()) << "tag " << mine.tag[static_cast<std::size_t>(target)];
        for (std::size_t n = 0; n < found.size(); ++n) {
            EXPECT_NEAR(found[n][0], expected[n][0], 1e-13);
            EXPECT_EQ(found[n][1], expected[n][1]);
        }
    }
    for (Index row = 0; row < points.position.rows(); ++row) {
        const Vector3 offset = (points.cellCentre.row(row) - points.position.row(row)).matrix().transpose();
        EXPECT_LT((offset - centreOffset).norm(), 1e-13) << "the cell centre did not move with its copy";
    }
}

TEST(ParticleHalo, givesTheSourcesOfAnOpenBox) { expectHaloEqualsBruteForce(0.4, {false, false, false}, 1); }

TEST(ParticleHalo, givesPeriodicCopiesInOneDirection) { expectHaloEqualsBruteForce(0.4, {false, true, false}, 2); }

TEST(ParticleHalo, givesPeriodicCopiesInAllDirections) { expectHaloEqualsBruteForce(0.3, {true, true, true}, 3); }

TEST(ParticleHalo, givesAllPeriodicCopiesWhenTheCutoffExceedsHalfTheBox)
{
    expectHaloEqualsBruteForce(1.4, {true, true, false}, 4);
}

TEST(ParticleHalo, givesACopyPerPeriodWhenTheCutoffIsOnePeriod) { expectHaloEqualsBruteForce(1.5, {false, true, false}, 5); }

TEST(ParticleHalo, findsPairsOfParticlesThatHaveStrayedOutOfThePeriodicBox)
{
    // A DEM wraps positions only when it rebuilds its lists: two particles near one face, one of them a period away.
    DemParticles all = emptyParticles(2);
    all.position.row(0) << 0.5, 2.0 - 0.05, 1;
    all.position.row(1) << 0.5, 3.5 - 0.10, 1;
    all.charge << 1, 2;
    ParticleHalo halo(0.2, box, {false, true, false}, MPI_COMM_WORLD);
    ChargedPoints points = ownPoints(dealt(all, MPI_COMM_WORLD));
    halo.extend(points);
    for (Index target = 0; target < points.targets; ++target) {
        const auto found = sourcesFromHalo(points, target, 0.2);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(found[0][0], 0.05, 1e-13);
    }
}

TEST(ParticleHalo, forwardsFurtherValuesInTheOrderOfTheRows)
{
    const DemParticles mine = dealt(randomParticles(60, box, 0.02, 1.0, Charges::random, 6), MPI_COMM_WORLD);
    ParticleHalo halo(0.7, box, {true, false, true}, MPI_COMM_WORLD);
    ChargedPoints points = ownPoints(mine);
    halo.extend(points);
    Scalars values = 10 * mine.charge;
    halo.forward(values);
    ASSERT_EQ(values.size(), points.charge.size());
    EXPECT_GT(values.size(), mine.size());
    EXPECT_TRUE((values == 10 * points.charge).all());
}

TEST(ParticleHalo, copesWithRanksThatHaveNoParticles)
{
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const DemParticles all = randomParticles(10, box, 0.02, 1.0, Charges::random, 7);
    ParticleHalo halo(0.5, box, {false, false, false}, MPI_COMM_WORLD);
    ChargedPoints points = ownPoints(rank == 0 ? all : emptyParticles(0));
    halo.extend(points);
    EXPECT_EQ(points.position.rows(), rank == 0 ? 10 : 0);
}

}  // namespace
}  // namespace him
