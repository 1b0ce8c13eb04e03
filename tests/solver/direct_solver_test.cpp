// SPDX-License-Identifier: GPL-3.0-or-later
// The solver by sine transforms against the difference operators that it inverts. Nothing of OpenFOAM.
#include "directSolve/directSolver.H"
#include "electrostatics/constants.hpp"
#include "tests/support/box_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace him {
namespace {

using Operator = directSolver::Operator;
using Place = std::array<Index, 3>;

/// Cells of three lengths, numbers of which no two are equal, one of them odd; more cells along x than ranks.
const std::array<Index, 3> count{6, 5, 8};
const Box space{Vector3(-0.3, 0.1, 2.0), Vector3(0.3, 1.1, 2.8)};

/// Values on all cells of the box, x fastest.
class Lattice {
public:
    Lattice() : values_(Scalars::Zero(count[0] * count[1] * count[2])) {}

    double& at(const Place& p) { return values_[p[0] + count[0] * (p[1] + count[1] * p[2])]; }
    double at(const Place& p) const { return values_[p[0] + count[0] * (p[1] + count[1] * p[2])]; }
    Scalars& values() { return values_; }
    const Scalars& values() const { return values_; }
    double largest() const { return values_.abs().maxCoeff(); }

private:
    Scalars values_;
};

void forCells(const std::function<void(const Place&)>& work)
{
    for (Index k = 0; k < count[2]; ++k) {
        for (Index j = 0; j < count[1]; ++j) {
            for (Index i = 0; i < count[0]; ++i) {
                work({i, j, k});
            }
        }
    }
}

Vector3 cellSize()
{
    return space.size().cwiseQuotient(
        Vector3(static_cast<double>(count[0]), static_cast<double>(count[1]), static_cast<double>(count[2])));
}

/// Minus the second difference in one direction, times the square of the cell; beyond a wall the values go on with their signs
/// turned, which puts a zero on it.
Lattice secondDifference(const Lattice& values, std::size_t axis)
{
    Lattice result;
    forCells([&](const Place& p) {
        double sum = 2 * values.at(p);
        for (const Index step : {-1, 1}) {
            Place other = p;
            other[axis] += step;
            const bool inside = other[axis] >= 0 && other[axis] < count[axis];
            sum -= inside ? values.at(other) : -values.at(p);
        }
        result.at(p) = sum;
    });
    return result;
}

/// What the operator makes of a potential: -laplacian [V/m2].
Lattice applied(const Lattice& potential, Operator kind)
{
    Lattice result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Lattice part = secondDifference(potential, axis);
        if (kind == Operator::matched) {
            // (-1, 16, -30, 16, -1)/12 is S + S S/12 of the second difference S; then the factor 1 - 0.02 S S.
            const Lattice twice = secondDifference(part, axis);
            part.values() += twice.values() / 12;
            const Lattice damping = secondDifference(secondDifference(part, axis), axis);
            part.values() -= 0.02 * damping.values();
        }
        const double step = cellSize()[static_cast<Index>(axis)];
        result.values() += part.values() / (step * step);
    }
    return result;
}

class DirectSolver : public testing::TestWithParam<Operator> {
protected:
    BoxMesh mesh{space, count, epsilon0, MPI_COMM_WORLD};
    std::unique_ptr<directSolver> solver = directSolver::create(mesh.arrays(), MPI_COMM_WORLD);

    Place placeOf(Index cell) const
    {
        const Vector3 at = (mesh.cellCentre(cell) - space.lower).cwiseQuotient(cellSize());
        return {static_cast<Index>(at.x()), static_cast<Index>(at.y()), static_cast<Index>(at.z())};
    }

    /// Of this rank's cells.
    Scalars share(const Lattice& all) const
    {
        Scalars own(mesh.cellCount());
        for (Index cell = 0; cell < own.size(); ++cell) {
            own[cell] = all.at(placeOf(cell));
        }
        return own;
    }

    Lattice gathered(const Scalars& own) const
    {
        Lattice all;
        for (Index cell = 0; cell < own.size(); ++cell) {
            all.at(placeOf(cell)) = own[cell];
        }
        MPI_Allreduce(MPI_IN_PLACE, all.values().data(), static_cast<int>(all.values().size()), MPI_DOUBLE, MPI_SUM,
                      MPI_COMM_WORLD);
        return all;
    }

    Lattice solved(const Lattice& density, Operator kind)
    {
        Scalars potential;
        solver->solve(share(density) * mesh.cellVolume(), kind, potential);
        return gathered(potential);
    }

    static Lattice noise(unsigned seed)
    {
        std::mt19937 dice(seed);
        std::uniform_real_distribution<double> uniform(-1, 1);
        Lattice values;
        forCells([&](const Place& p) { values.at(p) = uniform(dice); });
        return values;
    }

    static double difference(Lattice a, Lattice b)
    {
        a.values() -= b.values();
        return a.largest();
    }
};

TEST_P(DirectSolver, theOperatorMakesTheSourceOfTheSolution)
{
    const Lattice source = noise(1);
    EXPECT_LT(difference(applied(solved(source, GetParam()), GetParam()), source), 1e-12 * source.largest());
}

TEST_P(DirectSolver, aModeComesBackOverItsEigenvalue)
{
    // The longest, one in between, and the shortest waves, which change sign from cell to cell.
    for (const Place& mode : {Place{1, 1, 1}, Place{2, 4, 3}, Place{6, 5, 8}}) {
        Lattice wave;
        forCells([&](const Place& p) {
            double value = 1;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                value *= std::sin(pi * (static_cast<double>(p[axis]) + 0.5) * static_cast<double>(mode[axis])
                                  / static_cast<double>(count[axis]));
            }
            wave.at(p) = value;
        });
        double eigenvalue = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double theta = pi * static_cast<double>(mode[axis]) / static_cast<double>(count[axis]);
            const double second = 2 - 2 * std::cos(theta);
            const double fourth = (30 - 32 * std::cos(theta) + 2 * std::cos(2 * theta)) / 12;
            const double step = cellSize()[static_cast<Index>(axis)];
            eigenvalue +=
                (GetParam() == Operator::matched ? fourth * (1 - 0.02 * second * second) : second) / (step * step);
        }
        Lattice expected = wave;
        expected.values() /= eigenvalue;
        EXPECT_LT(difference(solved(wave, GetParam()), expected), 1e-13 * expected.largest()) << "mode " << mode[0];
    }
}

TEST_P(DirectSolver, twoChargesActOnEachOtherAlike)
{
    Lattice one, other;
    const Place here{1, 2, 3}, there{4, 0, 7};
    one.at(here) = 1;
    other.at(there) = 1;
    const double forth = solved(one, GetParam()).at(there);
    EXPECT_GT(forth, 0);
    EXPECT_NEAR(solved(other, GetParam()).at(here), forth, 1e-13 * solved(one, GetParam()).largest());
}

INSTANTIATE_TEST_SUITE_P(Operators, DirectSolver, testing::Values(Operator::finiteVolume, Operator::matched),
                         [](const auto& of) {
                             return std::string(of.param == Operator::matched ? "matched" : "finiteVolume");
                         });

class DirectSolverAtVoltages : public DirectSolver {};

TEST_F(DirectSolverAtVoltages, aPotentialThatRisesLinearlyBetweenItsWallsNeedsNoCharge)
{
    const auto ramp = [](const Vector3& x) { return 3 + x.dot(Vector3(2, -1, 0.5)); };
    const BoundaryFaces& faces = mesh.arrays().boundary;
    Scalars voltage(faces.size());
    for (Index face = 0; face < faces.size(); ++face) {
        voltage[face] = ramp(faces.centre.row(face).matrix().transpose());
    }
    Scalars source = Scalars::Zero(mesh.cellCount());
    solver->addBoundaryValues(faces, voltage, source);
    Scalars potential;
    solver->solve(source, Operator::finiteVolume, potential);
    for (Index cell = 0; cell < potential.size(); ++cell) {
        EXPECT_NEAR(potential[cell], ramp(mesh.cellCentre(cell)), 1e-12);
    }
}

TEST(DirectSolverOf, meshesThatAreNoClosedUniformBoxThereIsNone)
{
    const BoxMesh periodic(space, count, epsilon0, MPI_COMM_WORLD, {false, true, false});
    EXPECT_EQ(directSolver::create(periodic.arrays(), MPI_COMM_WORLD), nullptr);
    const BoxMesh box(space, count, epsilon0, MPI_COMM_WORLD);
    EXPECT_NE(directSolver::create(box.arrays(), MPI_COMM_WORLD), nullptr);
    // One rank's mesh is wrong; all must go without.
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MeshArrays insulated = box.arrays();
    MeshArrays displaced = box.arrays();
    MeshArrays larger = box.arrays();
    if (rank == 0) {
        insulated.boundary.condition.front() = FaceCondition::insulated;
        displaced.centre(0, 1) += 0.01 * cellSize()[1];
        larger.volume[0] *= 1.01;
    }
    EXPECT_EQ(directSolver::create(insulated, MPI_COMM_WORLD), nullptr);
    EXPECT_EQ(directSolver::create(displaced, MPI_COMM_WORLD), nullptr);
    EXPECT_EQ(directSolver::create(larger, MPI_COMM_WORLD), nullptr);
}

}  // namespace
}  // namespace him
