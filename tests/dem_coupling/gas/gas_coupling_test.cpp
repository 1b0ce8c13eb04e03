// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/gas_coupling.hpp"

#include "tests/support/collective_throw.hpp"
#include "tests/support/fake_dem.hpp"
#include "tests/support/fake_gas_mesh.hpp"
#include "tests/support/gas_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

/// One sphere in the middle of the cell at (12.5, 7.5, 7.5) mm, owned by the last rank.
DemParticles oneSphere()
{
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    DemParticles mine;
    resize(mine, rank == ranks - 1 ? 1 : 0);
    for (Index row = 0; row < mine.size(); ++row) {
        mine.tag = {1};
        mine.position.row(row) << 12.5e-3, 7.5e-3, 7.5e-3;
        mine.velocity.row(row) << 0.1, 0, -0.2;
    }
    return mine;
}

TEST(GasCoupling, laysASphereOnItsCellAndDragByTheLaw)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    for (const PressureModel pressure : {PressureModel::modelA, PressureModel::modelB}) {
        GasSettings settings = air();
        settings.pressure = pressure;
        FakeDem dem(oneSphere(), box, {false, false, false}, step, MPI_COMM_WORLD);
        GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
        LooseGas gas(mesh, settings);
        coupling.collect(dem.mine, gas.result.velocity);

        const double volume = 4 * pi / 3 * 8e-9;
        const double alpha = 1 - volume / cellVolume;
        const double slip = std::sqrt(0.9 * 0.9 + 0.2 * 0.2);
        double beta = wenYuDrag({alpha, slip, 4e-3, 100, 1e-3});
        beta = pressure == PressureModel::modelB ? beta / alpha : beta;
        const Index cell = mesh.findCell(Vector3(12.5e-3, 7.5e-3, 7.5e-3));
        const GasSources& sources = coupling.sources();
        for (Index other = 0; other < mesh.cellCount(); ++other) {
            EXPECT_NEAR(sources.voidFraction[other], other == cell ? alpha : 1, 1e-15);
            EXPECT_NEAR(sources.drag[other], other == cell ? beta / cellVolume : 0, 1e-13 * beta / cellVolume);
        }
        if (cell >= 0) {
            EXPECT_NEAR(sources.dragMomentum(cell, 0), 0.1 * beta / cellVolume, 1e-13 * beta / cellVolume);
            EXPECT_NEAR(sources.dragMomentum(cell, 2), -0.2 * beta / cellVolume, 1e-13 * beta / cellVolume);
        }
        EXPECT_NEAR(coupling.summary().solidVolume, volume, 1e-15 * volume);
        EXPECT_NEAR(coupling.summary().smallestVoidFraction, alpha, 1e-15);
    }
}

TEST(GasCoupling, countsParticlesBeyondWhatDragAndLiftHaveBeenShownFor)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    FakeDem dem(spheres(12), box, {false, false, false}, step, MPI_COMM_WORLD);
    GasSettings settings = air(VoidFractionModel::smoothed);
    settings.drag = "KochHill";
    settings.saffmanLift = true;
    GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
    LooseGas gas(mesh, settings);
    gas.result.acceleration.setZero(mesh.cellCount(), 3);
    gas.result.vorticity.setZero(mesh.cellCount(), 3);
    coupling.collect(dem.mine, gas.result.velocity);
    coupling.handBack(dem.mine, gas.result, 10 * step);
    EXPECT_EQ(coupling.summary().beyondDragLaw, 12);  // Re 200 to 700
    EXPECT_EQ(coupling.summary().beyondLift, 12);
    gas.result.velocity *= 1e-3;
    gas.result.vorticity.setConstant(0.1);
    dem.mine.velocity.setZero();
    coupling.collect(dem.mine, gas.result.velocity);
    coupling.handBack(dem.mine, gas.result, 10 * step);
    EXPECT_EQ(coupling.summary().beyondDragLaw, 0);
    EXPECT_EQ(coupling.summary().beyondLift, 0);
}

TEST(GasCoupling, saysOnAllRanksHowFarBeyondTheDragLawParticlesAre)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    FakeDem dem(oneSphere(), box, {false, false, false}, step, MPI_COMM_WORLD);
    GasSettings settings = air();
    settings.drag = "KochHill";
    GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
    LooseGas gas(mesh, settings);
    coupling.collect(dem.mine, gas.result.velocity);
    coupling.handBack(dem.mine, gas.result, 10 * step);
    const double alpha = 1 - 4 * pi / 3 * 8e-9 / cellVolume;
    EXPECT_NEAR(coupling.summary().voidFractionsBeyondDragLaw[0], alpha, 1e-14);
    EXPECT_NEAR(coupling.summary().voidFractionsBeyondDragLaw[1], alpha, 1e-14);
    EXPECT_EQ(dragLawNames(coupling.summary().othersBeyondDragLaw),
              (std::vector<std::string>{"WenYu", "Gidaspow", "Beetstra", "DiFelice"}));
    EXPECT_NEAR(coupling.summary().reynoldsBeyondDragLaw, alpha * 100 * std::hypot(0.9, 0.2) * 4e-3 / 1e-3, 1e-10);
}

TEST(GasCoupling, keepsTheSolidVolumeOfEveryModel)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    for (const VoidFractionModel model :
         {VoidFractionModel::centre, VoidFractionModel::divided, VoidFractionModel::smoothed}) {
        FakeDem dem(spheres(30), box, {false, false, false}, step, MPI_COMM_WORLD);
        GasSettings settings = air(model);
        settings.smallestVoidFraction = 1e-3;
        GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
        coupling.begin(dem.mine);
        const double volume = 30 * 4 * pi / 3 * 8e-9;
        EXPECT_NEAR(coupling.summary().solidVolume, volume, 1e-13 * volume);
    }
}

TEST(GasCoupling, countsCellsBelowTheSmallestVoidFractionAndWhatTheyHoldMore)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    FakeDem dem(oneSphere(), box, {false, false, false}, step, MPI_COMM_WORLD);
    GasSettings settings = air();
    settings.smallestVoidFraction = 0.9;
    GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
    coupling.begin(dem.mine);
    EXPECT_EQ(coupling.summary().boundedCells, 1);
    EXPECT_NEAR(coupling.summary().boundedVolume, 4 * pi / 3 * 8e-9 - 0.1 * cellVolume, 1e-15 * cellVolume);
    EXPECT_NEAR(overRanks((1 - coupling.sources().voidFraction).sum()), 0.1, 1e-14);
}

TEST(GasCoupling, refusesMoreSolidThanACellHolds)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    DemParticles large = oneSphere();
    large.radius *= 2;
    FakeDem dem(large, box, {false, false, false}, step, MPI_COMM_WORLD);
    GasCoupling coupling(dem, mesh, air(), MPI_COMM_WORLD);
    expectContains(textThrownOnAllRanks(MPI_COMM_WORLD, [&] { coupling.begin(dem.mine); }),
                   "a cell of the gas holds 2.14");
}

TEST(GasCoupling, namesTheFirstParticleOutsideTheMeshOnAllRanksUnlessItMayBeThere)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    DemParticles mine = spheres(12);
    for (Index row = 0; row < mine.size(); ++row) {
        if (mine.tag[static_cast<std::size_t>(row)] >= 6 && mine.tag[static_cast<std::size_t>(row)] <= 8) {
            mine.position.row(row) << 0.05, 0.01, 0.01;
        }
    }
    FakeDem dem(mine, box, {false, false, false}, step, MPI_COMM_WORLD);
    GasSettings settings = air();
    settings.smallestVoidFraction = 1e-3;
    {
        GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
        const std::string text = textThrownOnAllRanks(MPI_COMM_WORLD, [&] { coupling.begin(dem.mine); });
        expectContains(text,
                       "3 particle(s) are outside the mesh of the gas, among them particle 6 at (0.05 0.01 0.01) m");
    }
    settings.particlesOutsideAllowed = true;
    GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
    coupling.begin(dem.mine);
    EXPECT_EQ(coupling.summary().particlesOutside, 3);
}

TEST(GasCoupling, handsBackTheVelocityOfTheCellPressureAndBuoyancy)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    GasSettings settings = air();
    settings.gravity = Vector3(0, 0, -9.81);
    FakeDem dem(oneSphere(), box, {false, false, false}, step, MPI_COMM_WORLD);
    GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD);
    LooseGas gas(mesh, settings);
    gas.result.pressureForce.col(1) = 40;
    coupling.collect(dem.mine, gas.result.velocity);
    gas.result.velocity.col(0) = 3;
    coupling.handBack(dem.mine, gas.result, 10 * step);
    const double volume = 4 * pi / 3 * 8e-9;
    for (Index row = 0; row < dem.mine.size(); ++row) {
        EXPECT_EQ(dem.gas.velocity(row, 0), 3);
        EXPECT_NEAR(dem.gas.force(row, 1), 40 * volume, 1e-13 * volume);
        EXPECT_NEAR(dem.gas.buoyancy[2] * dem.gas.volume[row], 100 * 9.81 * volume, 1e-11 * volume);
        EXPECT_EQ(dem.gas.unpaid.rows(), 0);
    }
}

TEST(GasCoupling, givesAParticleTheVelocityOfItsPlaceAndTheGasTheSameForceByEveryModel)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    for (const VoidFractionModel model : {VoidFractionModel::centre, VoidFractionModel::divided}) {
        GasSettings settings = air(model);
        DemParticles mine = oneSphere();
        mine.position.col(1) -= 1e-3;
        FakeDem dem(mine, box, {false, false, false}, step, MPI_COMM_WORLD);
        Shear shear(mesh);
        GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD, &shear);
        LooseGas gas(mesh, settings);
        coupling.collect(dem.mine, gas.result.velocity);
        EXPECT_EQ(shear.updates, 1);
        gas.solve(coupling.sources(), 10 * step);
        coupling.handBack(dem.mine, gas.result, 10 * step);
        if (model == VoidFractionModel::centre) {
            const Index cell = mesh.findCell(Vector3(12.5e-3, 6.5e-3, 7.5e-3));
            const double ofCell = overRanks(cell >= 0 ? gas.result.velocity(cell, 0) : 0);
            for (Index row = 0; row < dem.mine.size(); ++row) {
                EXPECT_NEAR(dem.gas.velocity(row, 0), ofCell - 0.3, 1e-14);
            }
        }
        const Vector3 given = gas.result.given;
        EXPECT_NEAR((given - coupling.books().promised).norm(), 0, 1e-12 * given.norm());
        EXPECT_LT(coupling.books().mismatch(), 1e-12);
    }
}

TEST(GasCoupling, makesTheProfileOfTheVelocitiesThatParticlesFeel)
{
    const FakeGasMesh mesh(box, cells, MPI_COMM_WORLD);
    for (const VoidFractionModel model : {VoidFractionModel::centre, VoidFractionModel::smoothed}) {
        const GasSettings settings = air(model);
        FakeDem dem(oneSphere(), box, {false, false, false}, step, MPI_COMM_WORLD);
        Shear shear(mesh);
        GasCoupling coupling(dem, mesh, settings, MPI_COMM_WORLD, &shear);
        Points velocity(mesh.cellCount(), 3);
        for (Index cell = 0; cell < mesh.cellCount(); ++cell) {
            velocity.row(cell) = (100 * mesh.cellCentre(cell)).array().sin().transpose();
        }
        coupling.collect(dem.mine, velocity);
        ASSERT_EQ(shear.updatedBy.rows(), mesh.cellCount());
        for (int axis = 0; axis < 3; ++axis) {
            Scalars expected = velocity.col(axis);
            if (model == VoidFractionModel::smoothed) {
                mesh.smooth(expected, settings.smoothingLength);
                EXPECT_TRUE(expected.size() == 0 || (expected - velocity.col(axis)).abs().maxCoeff() > 1e-3);
            }
            EXPECT_TRUE((shear.updatedBy.col(axis) == expected).all()) << axis;
        }
    }
}

}  // namespace
}  // namespace him
