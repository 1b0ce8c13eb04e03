// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/mesh_locator.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

namespace him {
namespace {

const Box box{Vector3(0, 0, 0), Vector3(8, 4, 4)};
const std::array<Index, 3> cells{8, 4, 4};

double sumOverRanks(double mine)
{
    double all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return all;
}

Vector3 centreOfUnitCell(const Vector3& point)
{
    return point.array().floor().matrix() + Vector3::Constant(0.5);
}

TEST(MeshLocator, findsTheCellOfEveryParticleOnWhateverRank)
{
    const BoxMesh mesh(box, cells, 1.0, MPI_COMM_WORLD);
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(randomParticles(200, box, 0.01, 1.0, Charges::random, 1), MPI_COMM_WORLD);
    locator.locate(mine.position);
    Points centres;
    locator.cellCentres(mine.position, centres);
    for (Index row = 0; row < mine.size(); ++row) {
        ASSERT_TRUE(locator.inMesh(row));
        const Vector3 centre = centres.row(row).matrix().transpose();
        EXPECT_EQ(centre, centreOfUnitCell(mine.position.row(row).matrix().transpose()));
    }
}

TEST(MeshLocator, putsTheWholeParticleChargeOnTheMesh)
{
    const BoxMesh mesh(box, cells, 1.0, MPI_COMM_WORLD);
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(randomParticles(500, box, 0.01, 1e-9, Charges::random, 2), MPI_COMM_WORLD);
    Scalars cellCharge;
    locator.locate(mine.position);
    locator.deposit(mine.charge, cellCharge);
    ASSERT_EQ(cellCharge.size(), mesh.cellCount());
    const double absolute = sumOverRanks(mine.charge.abs().sum());
    EXPECT_NEAR(sumOverRanks(cellCharge.sum()), sumOverRanks(mine.charge.sum()), 1e-15 * absolute);
}

TEST(MeshLocator, bringsBackTheVectorOfTheCellThatHoldsEachParticle)
{
    const BoxMesh mesh(box, cells, 1.0, MPI_COMM_WORLD);
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(randomParticles(200, box, 0.01, 1.0, Charges::random, 3), MPI_COMM_WORLD);
    Points values;
    locator.locate(mine.position);
    locator.gather([&](Index cell) -> Vector3 { return 3 * mesh.cellCentre(cell) + Vector3(1, 2, 3); }, values);
    for (Index row = 0; row < mine.size(); ++row) {
        const Vector3 expected = 3 * centreOfUnitCell(mine.position.row(row).matrix().transpose()) + Vector3(1, 2, 3);
        EXPECT_EQ(Vector3(values.row(row).matrix().transpose()), expected);
    }
}

TEST(MeshLocator, carriesManyColumnsAsItCarriesOne)
{
    const BoxMesh mesh(box, cells, 1.0, MPI_COMM_WORLD);
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(randomParticles(300, box, 0.01, 1e-9, Charges::random, 4), MPI_COMM_WORLD);
    locator.locate(mine.position);

    const auto valuesOf = [&](Index row) {
        return std::array<double, 4>{mine.charge[row], mine.position(row, 0), mine.position(row, 1),
                                     mine.position(row, 2)};
    };
    CellValues ofCell;
    locator.deposit<4>(valuesOf, ofCell);
    ASSERT_EQ(ofCell.rows(), mesh.cellCount());
    ASSERT_EQ(ofCell.cols(), 4);
    for (std::size_t column = 0; column < 4; ++column) {
        Scalars ofRow(mine.size()), one;
        for (Index row = 0; row < mine.size(); ++row) {
            ofRow[row] = valuesOf(row)[column];
        }
        locator.deposit(ofRow, one);
        EXPECT_TRUE((ofCell.col(static_cast<Index>(column)) == one).all()) << column;
    }

    Points centres;
    locator.gather([&](Index cell) { return mesh.cellCentre(cell); }, centres);
    CellValues values(mesh.cellCount(), 4);
    for (Index cell = 0; cell < values.rows(); ++cell) {
        values.row(cell) << mesh.cellCentre(cell).transpose().array(), 2 * mesh.cellCentre(cell)[0];
    }
    std::vector<int> times(static_cast<std::size_t>(mine.size()));
    locator.gather(values, [&](Index row, const double* gathered) {
        ++times[static_cast<std::size_t>(row)];
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(gathered[axis], centres(row, axis));
        }
        EXPECT_EQ(gathered[3], 2 * centres(row, 0));
    });
    EXPECT_EQ(times, std::vector<int>(times.size(), 1)) << "every row is taken once";
}

TEST(MeshLocator, givesTheChargeOfAParticleOnAFaceBetweenRanksToExactlyOne)
{
    // One particle in every plane x = 1 ... 7, so on 2 and 4 ranks some sit exactly between two ranks.
    DemParticles all = emptyParticles(7);
    for (Index row = 0; row < 7; ++row) {
        all.position.row(row) << static_cast<double>(row + 1), 1.5, 2.5;
        all.charge[row] = 1;
    }
    const BoxMesh mesh(box, cells, 1.0, MPI_COMM_WORLD);
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(all, MPI_COMM_WORLD);
    Scalars cellCharge;
    Points values;
    locator.locate(mine.position);
    locator.deposit(mine.charge, cellCharge);
    locator.gather([&](Index cell) { return mesh.cellCentre(cell); }, values);
    EXPECT_EQ(sumOverRanks(cellCharge.sum()), 7.0);
    Points centres;
    locator.cellCentres(mine.position, centres);
    EXPECT_TRUE((values == centres).all()) << "charge and field belong to the same cell";
}

TEST(MeshLocator, leavesParticlesOutsideTheMeshOut)
{
    DemParticles all = emptyParticles(4);
    all.position << 0.5, 0.5, 0.5,  //
        -0.1, 2, 2,                 //
        4.5, 4.001, 2,              //
        7.5, 3.5, 3.5;
    all.charge << 1, 10, 100, 1000;
    const BoxMesh mesh(box, cells, 1.0, MPI_COMM_WORLD);
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(all, MPI_COMM_WORLD);
    Scalars cellCharge;
    Points values;
    locator.locate(mine.position);
    locator.deposit(mine.charge, cellCharge);
    locator.gather([](Index) -> Vector3 { return Vector3::Ones(); }, values);
    Eigen::ArrayXXd columns(mine.size(), 2);
    locator.gather(CellValues::Ones(mesh.cellCount(), 2),
                   [&](Index row, const double* gathered) { columns.row(row) << gathered[0], gathered[1]; });
    Points centres;
    locator.cellCentres(mine.position, centres);
    EXPECT_EQ(sumOverRanks(cellCharge.sum()), 1001.0);
    for (Index row = 0; row < mine.size(); ++row) {
        const int tag = mine.tag[static_cast<std::size_t>(row)];
        const bool inside = tag == 1 || tag == 4;
        EXPECT_EQ(locator.inMesh(row), inside);
        EXPECT_EQ(values(row, 0), inside ? 1.0 : 0.0);
        EXPECT_TRUE((columns.row(row) == (inside ? 1.0 : 0.0)).all());
        if (!inside) {
            EXPECT_TRUE((centres.row(row) == mine.position.row(row)).all());
        }
    }
}

TEST(MeshLocator, copesWithRanksThatHaveNoCells)
{
    const BoxMesh mesh(box, {1, 4, 4}, 1.0, MPI_COMM_WORLD);  // one slab: a single rank has cells
    MeshLocator locator(mesh, MPI_COMM_WORLD);
    const DemParticles mine = dealt(randomParticles(40, box, 0.01, 1.0, Charges::like, 4), MPI_COMM_WORLD);
    Scalars cellCharge;
    locator.locate(mine.position);
    locator.deposit(mine.charge, cellCharge);
    EXPECT_EQ(sumOverRanks(cellCharge.sum()), 40.0);
}

}  // namespace
}  // namespace him
