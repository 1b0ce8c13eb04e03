// SPDX-License-Identifier: GPL-3.0-or-later
// The stand-in for the real mesh must itself be right, or the tests that use it prove nothing.
#include "electrostatics/constants.hpp"
#include "tests/support/box_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

double onTheRankThatHolds(const BoxMesh& mesh, const Vector3& point, double valueIfMine)
{
    double value = mesh.findCell(point) >= 0 ? valueIfMine : 0;
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return value;
}

double errorOfSinePotential(Index n)
{
    const Box box{Vector3(0, 0, 0), Vector3(1, 2, 1)};
    BoxMesh mesh(box, {n, n, n}, 1.0, MPI_COMM_WORLD);
    const auto exact = [](const Vector3& x) { return std::sin(pi * x[0]) * std::sin(pi * x[1] / 2) * std::sin(pi * x[2]); };
    Scalars charge(mesh.cellCount());
    for (Index cell = 0; cell < charge.size(); ++cell) {
        charge[cell] = pi * pi * 2.25 * exact(mesh.cellCentre(cell)) * mesh.cellVolume();
    }
    mesh.solve(charge);
    double error = 0;
    for (Index cell = 0; cell < charge.size(); ++cell) {
        const Vector3 x = mesh.cellCentre(cell);
        error = std::max(error, std::fabs(mesh.potential(cell) - exact(x)));
        const double field = -pi * std::cos(pi * x[0]) * std::sin(pi * x[1] / 2) * std::sin(pi * x[2]);
        error = std::max(error, std::fabs(mesh.electricField(cell)[0] - field));
    }
    MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return error;
}

TEST(BoxMesh, solvesAManufacturedPotentialToSecondOrder)
{
    const double coarse = errorOfSinePotential(10);
    const double fine = errorOfSinePotential(20);
    EXPECT_LT(fine, 0.02);
    EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(BoxMesh, reachesTheCentrePotentialOfAGroundedCubeWithUniformCharge)
{
    // V_centre = 0.056213 rho L^2/eps, series solution.
    const double length = 0.1;
    const Box box{Vector3(0, 0, 0), Vector3::Constant(length)};
    const Index n = 31;
    BoxMesh mesh(box, {n, n, n}, epsilon0, MPI_COMM_WORLD);
    mesh.solve(Scalars::Constant(mesh.cellCount(), 1e-6 * mesh.cellVolume()));
    const Vector3 centre = Vector3::Constant(0.5 * length);
    const Index cell = mesh.findCell(centre);
    const double reached = onTheRankThatHolds(mesh, centre, cell >= 0 ? mesh.potential(cell) : 0);
    const double exact = 0.056213 * 1e-6 * length * length / epsilon0;
    EXPECT_NEAR(reached / exact, 1.0, 1.0 / (n * n));
}

TEST(BoxMesh, hasNoWallsInPeriodicDirections)
{
    const Box box{Vector3(0, 0, 0), Vector3(1, 1, 1)};
    BoxMesh mesh(box, {8, 6, 40}, 1.0, MPI_COMM_WORLD, {true, true, false});
    mesh.solve(Scalars::Constant(mesh.cellCount(), mesh.cellVolume()));
    for (Index cell = 0; cell < mesh.cellCount(); ++cell) {
        const double z = mesh.cellCentre(cell)[2];
        EXPECT_NEAR(mesh.potential(cell), 0.5 * z * (1 - z), 1e-3);  // plate capacitor with uniform charge
        EXPECT_NEAR(mesh.electricField(cell)[0], 0, 1e-12);
        EXPECT_NEAR(mesh.electricField(cell)[2], z - 0.5, 1e-12);
    }
}

}  // namespace
}  // namespace him
