// SPDX-License-Identifier: GPL-3.0-or-later
// The field methods that work by whole cells: himCell and hybridParticleCell.
#include "dem_coupling/field_method.hpp"
#include "electrostatics/constants.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

constexpr double coulomb = 1 / (4 * pi * epsilon0);
constexpr std::array<bool, 3> open{false, false, false};
constexpr double h = 2e-3;
constexpr Index cellsAlong = 15;
const Box box{Vector3::Zero(), Vector3::Constant(h* cellsAlong)};

struct Fields {
    std::map<int, Vector3> field;
    ParticleField mine;
};

Fields fieldOf(FieldSettings settings, const DemParticles& all, const std::array<bool, 3>& periodic = open)
{
    settings.permittivity = epsilon0;
    BoxMesh mesh(box, {cellsAlong, cellsAlong, cellsAlong}, epsilon0, MPI_COMM_WORLD, periodic);
    PhaseTimes times;
    const auto method = FieldMethod::create(settings, &mesh, box, periodic, MPI_COMM_WORLD, times);
    const DemParticles mine = dealt(all, MPI_COMM_WORLD);
    Fields fields;
    method->compute(mine, fields.mine);
    fields.field = gatherByTag(mine.tag, fields.mine.field, MPI_COMM_WORLD);
    return fields;
}

FieldSettings himCell(double deltaMin)
{
    FieldSettings settings;
    settings.method = "himCell";
    settings.himCell.deltaMin = deltaMin;
    return settings;
}

FieldSettings withCutoff(const std::string& method, double cutoff)
{
    FieldSettings settings;
    settings.method = method;
    settings.nearCutoff = cutoff;
    return settings;
}

DemParticles many() { return randomParticles(200, box, 1e-3, 1e-11, Charges::random, 3); }

/// Largest difference over the largest field.
double difference(const std::map<int, Vector3>& a, const std::map<int, Vector3>& b)
{
    EXPECT_EQ(a.size(), b.size());
    double apart = 0;
    double scale = 0;
    for (const auto& [tag, field] : a) {
        apart = std::max(apart, (field - b.at(tag)).norm());
        scale = std::max(scale, field.norm());
    }
    return apart / scale;
}

/// A unit source a little off the centre of the middle cell and a probe in the cell so many cells away.
DemParticles pairInCells(const Vector3& cellsApart)
{
    DemParticles two = emptyParticles(2);
    const Vector3 middle = Vector3::Constant(h * (cellsAlong / 2 + 0.5));
    two.position.row(0) = (middle + h * Vector3(0.2, -0.1, 0.3)).transpose().array();
    two.position.row(1) = (middle + h * (cellsApart + Vector3(-0.3, 0.25, 0.1))).transpose().array();
    two.charge << 1e-12, 1e-30;
    return two;
}

/// What the mesh alone gives at the probe.
Vector3 meshField(const DemParticles& two)
{
    BoxMesh mesh(box, {cellsAlong, cellsAlong, cellsAlong}, epsilon0, MPI_COMM_SELF);
    Scalars charge = Scalars::Zero(mesh.cellCount());
    charge[mesh.findCell(two.position.row(0).matrix().transpose())] = two.charge[0];
    mesh.solve(charge);
    return mesh.electricField(mesh.findCell(two.position.row(1).matrix().transpose()));
}

Vector3 coulombField(double charge, const Vector3& separation) { return coulomb * charge * separation / std::pow(separation.norm(), 3); }

/// Mesh field with the pair added and its double count taken out, S 2.18 to 2.21.
Vector3 interacting(const DemParticles& two, const Vector3& cellsApart)
{
    return meshField(two) + coulombField(two.charge[0], (two.position.row(1) - two.position.row(0)).matrix().transpose())
           - coulombField(two.charge[0], h * cellsApart);
}

TEST(HimCell, addsPairsOfTouchingCellsAndTakesOutWhatTheMeshHasOfTheirCharge)
{
    for (const Vector3& apart : {Vector3(1, 0, 0), Vector3(1, -1, 0), Vector3(-1, 1, 1)}) {
        const DemParticles two = pairInCells(apart);
        const Vector3 expected = interacting(two, apart);
        EXPECT_LT((fieldOf(himCell(0), two).field.at(2) - expected).norm(), 1e-12 * expected.norm()) << apart;
    }
}

TEST(HimCell, leavesCellsThatDoNotTouchToTheMeshWithoutADeltaMin)
{
    const DemParticles two = pairInCells({2, 0, 0});
    const Vector3 expected = meshField(two);
    EXPECT_LT((fieldOf(himCell(0), two).field.at(2) - expected).norm(), 1e-12 * expected.norm());
}

TEST(HimCell, countsTheShortestDistanceBetweenCellsAgainstDeltaMin)
{
    const Vector3 apart(2, 0, 0);  // one cell between them: h apart
    const DemParticles two = pairInCells(apart);
    const Vector3 near = interacting(two, apart);
    const Vector3 far = meshField(two);
    EXPECT_LT((fieldOf(himCell(1.01 * h), two).field.at(2) - near).norm(), 1e-12 * near.norm());
    EXPECT_LT((fieldOf(himCell(h), two).field.at(2) - far).norm(), 1e-12 * far.norm());  // below, not at
    const Vector3 diagonal(2, 2, 0);  // sqrt(2) h apart
    const DemParticles others = pairInCells(diagonal);
    const Vector3 nearDiagonal = interacting(others, diagonal);
    const Vector3 farDiagonal = meshField(others);
    EXPECT_LT((fieldOf(himCell(1.42 * h), others).field.at(2) - nearDiagonal).norm(), 1e-12 * nearDiagonal.norm());
    EXPECT_LT((fieldOf(himCell(1.41 * h), others).field.at(2) - farDiagonal).norm(), 1e-12 * farDiagonal.norm());
}

TEST(HimCell, equalsHimWhenAllPairsAreNearInBoth)
{
    EXPECT_LT(difference(fieldOf(himCell(2 * cellsAlong * h), many()).field,
                         fieldOf(withCutoff("him", 2 * cellsAlong * h), many()).field),
              1e-12);
}

TEST(HimCell, seesInteractingCellsThroughAPeriodicFace)
{
    DemParticles inside = many();
    DemParticles shifted = inside;
    const double shift = 7 * h;
    for (Index row = 0; row < inside.size(); ++row) {
        shifted.position(row, 0) = std::fmod(inside.position(row, 0) + shift, cellsAlong * h);
    }
    const std::array<bool, 3> inX{true, false, false};
    EXPECT_LT(difference(fieldOf(himCell(1.5 * h), inside, inX).field, fieldOf(himCell(1.5 * h), shifted, inX).field), 1e-11);
}

TEST(HimCell, hasNoPotential)
{
    const Fields fields = fieldOf(himCell(0), many());
    EXPECT_EQ(fields.mine.potential.size(), 0);
    EXPECT_TRUE(std::isnan(fields.mine.energy));
}

TEST(HybridParticleCell, letsAFarCellActWithItsChargeAtItsCentroid)
{
    const Vector3 apart(4, -1, 0);
    DemParticles three = emptyParticles(3);
    const DemParticles two = pairInCells(apart);
    three.position.topRows(2) = two.position;
    three.position.row(2) = two.position.row(0) - 0.2 * h;  // in the cell of the first
    three.charge << 1e-12, 1e-30, -3e-12;
    const Vector3 centroid = Vector3::Constant(h * (cellsAlong / 2 + 0.5));
    const Vector3 expected = coulombField(-2e-12, two.position.row(1).matrix().transpose() - centroid);
    const Fields fields = fieldOf(withCutoff("hybridParticleCell", 3 * h), three);
    EXPECT_LT((fields.field.at(2) - expected).norm(), 1e-13 * expected.norm());
}

TEST(HybridParticleCell, decidesByTheDistanceOfTheCentroids)
{
    const Vector3 apart(3, 0, 0);
    const DemParticles two = pairInCells(apart);  // the charges are 2.5 h apart
    const Vector3 exact = coulombField(two.charge[0], (two.position.row(1) - two.position.row(0)).matrix().transpose());
    const Vector3 atCutoff = fieldOf(withCutoff("hybridParticleCell", 3 * h), two).field.at(2);
    const Vector3 below = fieldOf(withCutoff("hybridParticleCell", 2.99 * h), two).field.at(2);
    EXPECT_LT((atCutoff - exact).norm(), 1e-13 * exact.norm());
    EXPECT_GT((below - exact).norm(), 0.05 * exact.norm());
}

TEST(HybridParticleCell, equalsThePairwiseSumWhenAllCellsAreNear)
{
    const Fields hybrid = fieldOf(withCutoff("hybridParticleCell", 2 * cellsAlong * h), many());
    const Fields sum = fieldOf(withCutoff("pairwiseSum", 0), many());
    EXPECT_LT(difference(hybrid.field, sum.field), 1e-13);
    EXPECT_LT((hybrid.mine.potential - sum.mine.potential).abs().maxCoeff(), 1e-13 * sum.mine.potential.abs().maxCoeff());
    EXPECT_NEAR(hybrid.mine.energy, sum.mine.energy, 1e-12 * std::fabs(sum.mine.energy));
}

TEST(HybridParticleCell, comesNearerToThePairwiseSumWithALargerCutoff)
{
    const auto exact = fieldOf(withCutoff("pairwiseSum", 0), many()).field;
    const double at2 = difference(fieldOf(withCutoff("hybridParticleCell", 2 * h), many()).field, exact);
    const double at4 = difference(fieldOf(withCutoff("hybridParticleCell", 4 * h), many()).field, exact);
    EXPECT_LT(at4, 0.5 * at2);
}

}  // namespace
}  // namespace him
