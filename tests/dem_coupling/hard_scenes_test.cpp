// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes at the edge of what a field method is made for: extreme charges and sizes, particles on faces, edges and corners of
// cells and in walls, ranks without work.
#include "dem_coupling/accuracy_choice.hpp"
#include "dem_coupling/field_method.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/reference/grounded_box.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

constexpr std::array<bool, 3> open{false, false, false};
const MPI_Comm world = MPI_COMM_WORLD;
constexpr double side = 0.016;
constexpr double d = 1e-3;
const Box cube{Vector3(0, 0, 0), Vector3(side, side, side)};

FieldSettings settingsOf(const std::string& method)
{
    FieldSettings settings;
    settings.method = method;
    settings.nearCutoff = 4e-3;
    settings.permittivity = epsilon0;
    return settings;
}

/// What this rank holds of all particles; every rank passes the same `all`.
using Share = DemParticles (*)(const DemParticles& all);

DemParticles cards(const DemParticles& all)
{
    return dealt(all, world);
}

DemParticles everythingOnTheLastRank(const DemParticles& all)
{
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(world, &rank);
    MPI_Comm_size(world, &ranks);
    return select(all, [&](Index) { return rank == ranks - 1; });
}

struct Outcome {
    std::map<int, Vector3> field;  ///< by tag
    double energy = 0;
};

Outcome outcomeOf(const FieldSettings& settings, const DemParticles& all, const Box& box = cube, Index cells = 8,
                  Share share = cards)
{
    PhaseTimes times;
    BoxMesh mesh(box, {cells, cells, cells}, settings.permittivity, world);
    const auto method = FieldMethod::create(settings, &mesh, box, open, world, times);
    const DemParticles mine = share(all);
    ParticleField result;
    method->compute(mine, result);
    Outcome outcome{gatherByTag(mine.tag, result.field, world), result.energy};
    MPI_Allreduce(MPI_IN_PLACE, &outcome.energy, 1, MPI_DOUBLE, MPI_SUM, world);
    return outcome;
}

double rms(const std::map<int, Vector3>& fields)
{
    double sum = 0;
    for (const auto& [tag, field] : fields) {
        sum += field.squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(fields.size()));
}

void expectSame(const std::map<int, Vector3>& a, const std::map<int, Vector3>& b, double tolerance)
{
    ASSERT_EQ(a.size(), b.size());
    const double scale = rms(b);
    ASSERT_GT(scale, 0);
    for (const auto& [tag, field] : a) {
        EXPECT_LT((field - b.at(tag)).norm(), tolerance * scale) << "tag " << tag;
    }
}

DemParticles crowd(double charge = 1e-12, Charges charges = Charges::random)
{
    Box inside = cube;
    inside.lower.array() += 0.6 * d;
    inside.upper.array() -= 0.6 * d;
    return randomParticles(300, inside, d, charge, charges, 7);
}

/// RMS error against the exact field of the box, relative to the RMS field.
double errorOf(const std::map<int, Vector3>& fields, const DemParticles& all, const Box& box)
{
    Points exact;
    Scalars potential;
    GroundedBox(box, epsilon0).compute(all.position, all.charge, exact, potential);
    double sum = 0;
    for (Index row = 0; row < all.size(); ++row) {
        sum += (fields.at(all.tag[static_cast<std::size_t>(row)]) - exact.row(row).matrix().transpose()).squaredNorm();
    }
    return std::sqrt(sum / exact.square().sum());
}

class HardScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(OfEveryMethod, HardScene, testing::ValuesIn(FieldMethod::names()),
                         [](const auto& method) { return method.param; });

TEST_P(HardScene, withoutAnyChargeHasNoFieldAndNoEnergy)
{
    const Outcome outcome = outcomeOf(settingsOf(GetParam()), crowd(0));
    for (const auto& [tag, field] : outcome.field) {
        EXPECT_EQ(field.norm(), 0) << "tag " << tag;
    }
    if (!std::isnan(outcome.energy)) {
        EXPECT_EQ(outcome.energy, 0);
    }
}

TEST_P(HardScene, hasHalfTheFieldInAGasOfTwiceThePermittivityAndTheExternalFieldInFull)
{
    const DemParticles all = randomParticles(60, cube, d, 1e-12, Charges::random, 9);
    FieldSettings settings = settingsOf(GetParam());
    const Outcome once = outcomeOf(settings, all);
    settings.permittivity = 2 * epsilon0;
    settings.externalField = Vector3(1e4, -2e4, 3e4);
    const Outcome twice = outcomeOf(settings, all);
    std::map<int, Vector3> expected;
    for (const auto& [tag, field] : once.field) {
        expected[tag] = 0.5 * field + settings.externalField;
    }
    expectSame(twice.field, expected, 1e-10);
}

TEST_P(HardScene, ofChargesOverNineDecadesIsTheSumOfItsDecades)
{
    const FieldSettings settings = settingsOf(GetParam());
    DemParticles all = crowd(1);
    for (Index row = 0; row < all.size(); ++row) {
        all.charge[row] *= std::pow(10.0, -15 + static_cast<double>(row % 10));  // 1e-15 to 1e-6 C
    }
    const auto together = outcomeOf(settings, all).field;
    std::map<int, Vector3> sum;
    for (int decade = 0; decade < 10; ++decade) {
        DemParticles some = all;
        for (Index row = 0; row < all.size(); ++row) {
            some.charge[row] = row % 10 == decade ? all.charge[row] : 0;
        }
        for (const auto& [tag, field] : outcomeOf(settings, some).field) {
            auto [at, fresh] = sum.try_emplace(tag, Vector3::Zero());
            at->second += field;
        }
    }
    expectSame(together, sum, 1e-10);
}

TEST_P(HardScene, isTheSameWhenOneRankHoldsAllParticles)
{
    const FieldSettings settings = settingsOf(GetParam());
    expectSame(outcomeOf(settings, crowd(), cube, 8, everythingOnTheLastRank).field, outcomeOf(settings, crowd()).field,
               1e-11);
}

TEST_P(HardScene, movesAlongWhenEverythingIsMoved)
{
    const FieldSettings settings = settingsOf(GetParam());
    const Vector3 away(1.25, -3.5, 0.75);
    DemParticles moved = crowd();
    moved.position.rowwise() += away.transpose().array();
    const Box there{cube.lower + away, cube.upper + away};
    // Positions of some metres lose 1e-16 m, a share of 1e-12 of the distances that matter.
    expectSame(outcomeOf(settings, moved, there).field, outcomeOf(settings, crowd()).field, 1e-8);
}

TEST_P(HardScene, takesParticlesOnFacesEdgesAndCornersOfCells)
{
    // A touch to either side of a face, of an edge and of a corner of the cells of 2 mm, beside other charges.
    const double h = side / 8;
    const FieldSettings settings = settingsOf(GetParam());
    for (int axes = 1; axes <= 3; ++axes) {
        std::map<int, Vector3> sides[3];
        for (int n = 0; n < 3; ++n) {
            DemParticles all = emptyParticles(3);
            Vector3 place(0.5 * h, 0.5 * h, 0.5 * h);
            for (int axis = 0; axis < axes; ++axis) {
                place[axis] = (n - 1) * 1e-3 * h;
            }
            all.position.row(0) = (Vector3::Constant(4 * h) + place).transpose().array();
            all.position.row(1) = Vector3(3.1 * h, 5.3 * h, 4.2 * h).transpose().array();
            all.position.row(2) = Vector3(6.2 * h, 2.7 * h, 3.3 * h).transpose().array();
            all.charge << 1e-12, -2e-12, 1.5e-12;
            all.radius.setConstant(d / 2);
            sides[n] = outcomeOf(settings, all).field;
            for (const auto& [tag, field] : sides[n]) {
                EXPECT_TRUE(field.allFinite());
                EXPECT_TRUE(field.norm() > 0 || GetParam() == "directTruncation") << "tag " << tag;
            }
        }
        if (GetParam() == "p3m" || GetParam() == "pairwiseSum") {
            // No kick: q/(4 pi eps h^2) times the jump that is allowed at a face.
            const double unit = 2e-12 / (4 * pi * epsilon0 * h * h);
            EXPECT_LT((sides[0].at(1) - sides[2].at(1)).norm(), 0.06 * unit) << axes << " axes";
        }
    }
}

TEST(HardSceneOfP3m, keepsTheImageForceOfAParticleThatOverlapsAWall)
{
    FieldSettings settings = settingsOf("p3m");
    settings.p3m.cloudCells = 3;
    settings.p3m.gather = PolynomialOrder::quartic;
    const double q = 1e-12;
    for (const double gap : {d / 4, d / 20}) {
        DemParticles all = emptyParticles(1);
        all.position.row(0) << gap, side / 2, side / 2;
        all.charge << q;
        all.radius.setConstant(d / 2);
        const Vector3 field = outcomeOf(settings, all).field.at(1);
        const double image = q / (16 * pi * epsilon0 * gap * gap);
        EXPECT_NEAR(field.x() / -image, 1, 0.01) << gap;
        EXPECT_LT(std::hypot(field.y(), field.z()), 0.01 * image);
    }
}

TEST(HardSceneOfP3m, isAccurateWithCellsMuchSmallerAndMuchLargerThanParticles)
{
    const DemParticles all = crowd();
    FieldSettings settings = settingsOf("p3m");
    EXPECT_LT(errorOf(outcomeOf(settings, all, cube, 4).field, all, cube), expectedError(settings));  // cells of 4 d
    // Errors are shares of q/(4 pi eps h^2), so that cells below d need larger clouds: h = d/2 has four times the error of h = d.
    settings.p3m.cloudCells = 4;
    settings.p3m.gather = PolynomialOrder::quartic;
    EXPECT_LT(errorOf(outcomeOf(settings, all, cube, 32).field, all, cube), 4 * 0.005);
}

TEST(HardSceneOfP3m, givesChargesTenTimesTheirNeighboursSizeTheirField)
{
    // 1:10 in diameter: small ones touch large ones; the field knows centres only, distances differ tenfold.
    DemParticles all = emptyParticles(8);
    const Vector3 centre = Vector3::Constant(side / 2);
    all.position.row(0) = centre.transpose().array();
    all.charge[0] = 1e-11;
    for (int n = 1; n < 8; ++n) {
        const double angle = 0.7 * n;
        const Vector3 direction(std::cos(angle), std::sin(angle) * std::cos(2 * angle),
                                std::sin(angle) * std::sin(2 * angle));
        all.position.row(n) = (centre + 2.2 * d * direction).transpose().array();
        all.charge[n] = -1e-13;
    }
    all.radius.setConstant(0.2 * d);
    all.radius[0] = 2 * d;
    const FieldSettings settings = settingsOf("p3m");
    EXPECT_LT(errorOf(outcomeOf(settings, all).field, all, cube), expectedError(settings));
}

}  // namespace
}  // namespace him
