// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/fake_dem.hpp"
#include "tests/support/fake_gas_mesh.hpp"
#include "tests/support/gas_scenes.hpp"

#include <gtest/gtest.h>

namespace him {
namespace {

Vector3 momentum(const DemParticles& particles)
{
    const Points all = particles.velocity.colwise() * particles.mass;
    return overRanks(Vector3(all.colwise().sum().matrix().transpose()));
}

class Books : public testing::TestWithParam<VoidFractionModel> {};

TEST_P(Books, keepTheMomentumOfGasParticlesAndWhatWasTakenOut)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    GasSettings settings = air(GetParam());
    settings.smallestVoidFraction = 1e-3;
    FakeDem dem(spheres(12), box, {true, true, true}, step, MPI_COMM_WORLD);
    dem.setField(dem.mine, Points::Zero(dem.mine.size(), 3), Points());
    dem.handOver();
    Shear shear(mesh);
    GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD, &shear);
    LooseGas gas(mesh, settings);
    coupling.begin(dem.mine);
    const Vector3 start = gas.momentum() + momentum(dem.mine);
    Vector3 left = Vector3::Zero();
    int round = 0;
    dem.duringRun = [&] {
        // Every 8th gas step the last particle of the rank that has most goes, with its momentum and what the gas gave it.
        double gone[3] = {0, 0, 0};
        Index most = dem.mine.size();
        MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
        if (++round % 8 == 0 && most > 1 && dem.mine.size() == most) {
            const Index last = most - 1;
            for (int axis = 0; axis < 3; ++axis) {
                gone[axis] = dem.mine.mass[last] * dem.mine.velocity(last, axis);
            }
            if (dem.gasGiven.rows() == most) {
                dem.gasTakenOut += dem.gasGiven.row(last).matrix().transpose();
                dem.gasGiven.conservativeResize(last, 3);
                dem.gasPromised.conservativeResize(last, 3);
            }
            resize(dem.mine, last);
            dem.heldField.setZero(last, 3);
        }
        left += overRanks(Vector3(gone));
    };
    double worst = 0;
    for (int n = 0; n < 60; ++n) {
        dem.run(10);
        coupling.collect(dem.mine, gas.result.velocity);
        gas.solve(coupling.sources(), 10 * step);
        coupling.handBack(dem.mine, gas.result, 10 * step);
        const MomentumBooks& books = coupling.books();
        const Vector3 total = gas.momentum() + momentum(dem.mine) + left + books.given - books.got;
        EXPECT_LT((total - start).norm(), 1e-12 * start.norm()) << "step " << n;
        EXPECT_LT((books.given - books.got - books.ahead).norm(), 1e-12 * start.norm());
        worst = std::max(worst, (books.ahead - books.promised).norm());
    }
    EXPECT_GT(left.norm(), 1e-3 * start.norm());
    // The gas is ahead by no more than its last solve promised; where shares of faces and cells are one, to rounding.
    EXPECT_LT(worst, 1e-12 * start.norm());
}

INSTANTIATE_TEST_SUITE_P(OfEveryModel, Books,
                         testing::Values(VoidFractionModel::centre, VoidFractionModel::divided,
                                         VoidFractionModel::smoothed));

}  // namespace
}  // namespace him
