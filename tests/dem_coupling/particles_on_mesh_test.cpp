// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/particles_on_mesh.hpp"

#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace him {
namespace {

const Box box{Vector3(0, 0, 0), Vector3(8, 4, 4)};
constexpr std::array<Index, 3> cells{8, 4, 4};
constexpr double reach = 1.5;

/// 300 charges in the box and 20 above it, dealt to the ranks wherever the cells are.
class Dealt : public testing::Test {
protected:
    Dealt()
    {
        all.position.bottomRows(20).col(2) += 10;
        mine = dealt(all, MPI_COMM_WORLD);
        locator.locate(mine.position);
        onMesh.distribute(locator, mine, halo, reach, sources);
    }
    /// Row of `all` with a tag.
    static Index rowOf(int tag) { return tag - 1; }

    const BoxMesh mesh{box, cells, 1.0, MPI_COMM_WORLD};
    MeshLocator locator{mesh, MPI_COMM_WORLD};
    MeshHalo halo{mesh.arrays(), reach, 1, MPI_COMM_WORLD};
    DemParticles all = randomParticles(320, box, 0.01, 1e-9, Charges::random, 7);
    DemParticles mine;
    ParticlesOnMesh onMesh;
    CloudSources sources;
};

TEST_F(Dealt, chargesComeToTheRankOfTheirCellSortedByCell)
{
    long targets = sources.targets;
    MPI_Allreduce(MPI_IN_PLACE, &targets, 1, MPI_LONG, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_EQ(targets, 300);
    ASSERT_EQ(onMesh.tags().size(), static_cast<std::size_t>(sources.targets));
    EXPECT_TRUE(std::is_sorted(sources.cell.begin(), sources.cell.begin() + sources.targets));
    for (Index target = 0; target < sources.targets; ++target) {
        const Index row = rowOf(onMesh.tags()[static_cast<std::size_t>(target)]);
        EXPECT_EQ(sources.charge[target], all.charge[row]);
        EXPECT_TRUE((sources.position.row(target) == all.position.row(row)).all());
        const Vector3 place = sources.position.row(target).matrix().transpose();
        EXPECT_EQ(sources.cell[static_cast<std::size_t>(target)], mesh.findCell(place));
    }
}

TEST_F(Dealt, copiesOfOtherRanksChargesFollowAsFarAsTheReach)
{
    const MeshArrays& arrays = mesh.arrays();
    Box centres;
    for (Index cell = 0; cell < arrays.cells(); ++cell) {
        centres.extend(arrays.centre.row(cell).matrix().transpose());
    }
    double expected = 0;
    for (Index row = 0; row < 300; ++row) {
        const Vector3 place = all.position.row(row).matrix().transpose();
        const Vector3 nearest = place.cwiseMax(centres.lower).cwiseMin(centres.upper);
        if (!centres.empty() && mesh.findCell(place) < 0 && (place - nearest).norm() <= reach) {
            expected += all.charge[row];
        }
    }
    const double found = sources.charge.tail(sources.size() - sources.targets).sum();
    EXPECT_NEAR(found, expected, 1e-14 * all.charge.abs().sum());
}

TEST_F(Dealt, resultsComeBackToTheParticlesAndZeroToThoseOutside)
{
    Eigen::ArrayXXd atTargets(sources.targets, 2), atRows(mine.size(), 2);
    for (Index target = 0; target < sources.targets; ++target) {
        atTargets.row(target) << onMesh.tags()[static_cast<std::size_t>(target)], sources.position(target, 0);
    }
    atRows.setConstant(7);
    Index taken = 0;
    onMesh.bringBack(atTargets, halo.exchange(), [&](Index row, const double* values) {
        atRows.row(row) << values[0], values[1];
        ++taken;
    });
    EXPECT_EQ(taken, mine.size());
    for (Index row = 0; row < mine.size(); ++row) {
        const int tag = mine.tag[static_cast<std::size_t>(row)];
        const bool inside = rowOf(tag) < 300;
        EXPECT_EQ(atRows(row, 0), inside ? tag : 0);
        EXPECT_EQ(atRows(row, 1), inside ? mine.position(row, 0) : 0);
    }
}

}  // namespace
}  // namespace him
