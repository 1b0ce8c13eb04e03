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

FieldSettings p3m(double cloudCells)
{
    FieldSettings settings = settingsOf("p3m");
    settings.p3m.cloudCells = cloudCells;
    settings.p3m.gather = cloudCells > 2 ? PolynomialOrder::quartic : PolynomialOrder::cubic;
    settings.p3m.deferredCorrection = cloudCells > 2;
    return settings;
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

TEST(HardSceneOfP3m, hasTheImageForceOfAChargeAThousandthOfACellFromAWallAnEdgeAndACorner)
{
    const double h = side / 8;
    const double a = 1e-3 * h;
    const double q = 1e-12;
    for (const double cloudCells : {2., 3.}) {
        for (int walls = 1; walls <= 3; ++walls) {
            for (const bool upper : {false, true}) {
                // Images in 1, 2 or 3 perpendicular conductors: those mirrored n times have the sign (-1)^n and stand 2 a away
                // along n axes. The other walls, thousands of times as far, make less than 1e-6 of the field.
                Vector3 place(3.7 * h, 4.2 * h, 3.9 * h);
                Vector3 exact = Vector3::Zero();
                for (int axis = 0; axis < walls; ++axis) {
                    place[axis] = upper ? side - a : a;
                }
                for (int mirrored = 1; mirrored < 1 << walls; ++mirrored) {
                    Vector3 away = Vector3::Zero();  // from the image to the charge
                    double sign = 1;
                    for (int axis = 0; axis < walls; ++axis) {
                        if (mirrored >> axis & 1) {
                            away[axis] = upper ? -2 * a : 2 * a;
                            sign = -sign;
                        }
                    }
                    exact += sign * q / (4 * pi * epsilon0) * away / std::pow(away.norm(), 3);
                }
                if (walls == 1) {
                    EXPECT_NEAR(exact.norm(), q / (16 * pi * epsilon0 * a * a), 1e-9 * exact.norm());
                }
                DemParticles all = emptyParticles(1);
                all.position.row(0) = place.transpose().array();
                all.charge << q;
                all.radius.setConstant(d / 2);
                const Vector3 field = outcomeOf(p3m(cloudCells), all).field.at(1);
                EXPECT_LT((field - exact).norm(), 0.01 * exact.norm()) << walls << " walls, R = " << cloudCells << " h";
            }
        }
    }
}

/// Two spheres in contact, +q and -q, point-symmetric about the centre of a grounded box with cells of 2 d.
struct TouchingPair {
    const char* name;
    std::array<Index, 3> cells;  ///< odd along an axis: the box's centre is that of a cell; even: it lies on a face
    Vector3 axis;                ///< from +q to -q
};

void PrintTo(const TouchingPair& pair, std::ostream* out)
{
    *out << pair.name;
}

class TouchingOppositeCharges : public testing::TestWithParam<TouchingPair> {
protected:
    /// @param allowed  error of the field at either, relative to the exact field there
    void expectForces(FieldSettings settings, double allowed) const
    {
        const double h = 2 * d;
        const auto& cells = GetParam().cells;
        const Box box{
            Vector3::Zero(),
            h * Vector3(static_cast<double>(cells[0]), static_cast<double>(cells[1]), static_cast<double>(cells[2]))};
        const double q = 1e-12;
        DemParticles all = emptyParticles(2);
        const Vector3 centre = 0.5 * (box.lower + box.upper);
        const Vector3 half = 0.5 * d * GetParam().axis.normalized();
        all.position.row(0) = (centre - half).transpose().array();
        all.position.row(1) = (centre + half).transpose().array();
        all.charge << q, -q;
        all.radius.setConstant(d / 2);
        if (settings.method == "pairwiseSum") {
            settings.pairwiseSum.images = true;
            settings.pairwiseSum.imageWalls = wallsOf(box);
        }
        BoxMesh mesh(box, cells, epsilon0, world);
        PhaseTimes times;
        const DemParticles mine = dealt(all, world);
        ParticleField result;
        FieldMethod::create(settings, &mesh, box, open, world, times)->compute(mine, result);
        const auto field = gatherByTag(mine.tag, result.field, world);
        Points exact;
        Scalars potential;
        GroundedBox(box, epsilon0).compute(all.position, all.charge, exact, potential);
        const Vector3 first = q * field.at(1);
        const Vector3 second = -q * field.at(2);
        EXPECT_LT((first + second).norm(), 1e-9 * first.norm()) << "not equal and opposite";
        EXPECT_GT(first.dot(half), 0) << "opposite charges attract";
        for (const int tag : {1, 2}) {
            const Vector3 there = exact.row(tag - 1).matrix().transpose();
            EXPECT_LT((field.at(tag) - there).norm(), allowed * there.norm()) << "tag " << tag;
        }
    }
};
INSTANTIATE_TEST_SUITE_P(AtTheCentreOfABox, TouchingOppositeCharges,
                         testing::Values(TouchingPair{"inOneCell", {9, 9, 9}, Vector3(3, 2, -1)},
                                         TouchingPair{"acrossACellFace", {8, 9, 9}, Vector3(3, 2, -1)},
                                         TouchingPair{"straightAcrossACellFace", {8, 9, 9}, Vector3(1, 0, 0)}),
                         [](const auto& pair) { return std::string(pair.param.name); });

TEST_P(TouchingOppositeCharges, attractEachOtherAsExactlyAsThePairSumPromises)
{
    expectForces(settingsOf("pairwiseSum"), errorBetweenParallelWalls);
}

TEST_P(TouchingOppositeCharges, attractEachOtherWithTheErrorOfPublishedHim)
{
    // Its worst scene in the table of p3m.md.
    expectForces(settingsOf("him"), 0.32);
}

TEST_P(TouchingOppositeCharges, attractEachOtherAsExactlyAsTheCloudsOfP3mPromise)
{
    for (const double cloudCells : {2., 3.}) {
        expectForces(p3m(cloudCells), expectedError(p3m(cloudCells)));
    }
}

}  // namespace
}  // namespace him
