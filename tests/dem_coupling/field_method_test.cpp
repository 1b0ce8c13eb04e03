// SPDX-License-Identifier: GPL-3.0-or-later
// What all field methods have in common, and what each refuses.
#include "dem_coupling/field_method.hpp"
#include "dem_coupling/field_methods/p3m.hpp"
#include "electrostatics/constants.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/collective_throw.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace him {
namespace {

const Box box{Vector3(0, 0, 0), Vector3(0.04, 0.03, 0.02)};
const std::array<Index, 3> cells{16, 12, 8};  // 2.5 mm cells, diagonal 4.33 mm
constexpr std::array<bool, 3> open{false, false, false};

FieldSettings settingsOf(const std::string& method)
{
    FieldSettings settings;
    settings.method = method;
    settings.nearCutoff = 6e-3;
    settings.permittivity = epsilon0;
    return settings;
}

/// Field by tag of particles that are dealt over the ranks of the communicator, as is the mesh.
std::map<int, Vector3> fieldOf(const FieldSettings& settings, const DemParticles& all, MPI_Comm communicator)
{
    PhaseTimes times;
    BoxMesh mesh(box, cells, settings.permittivity, communicator);
    const auto method = FieldMethod::create(settings, &mesh, box, open, communicator, times);
    const DemParticles mine = dealt(all, communicator);
    ParticleField result;
    method->compute(mine, result);
    return gatherByTag(mine.tag, result.field, communicator);
}

double largest(const std::map<int, Vector3>& fields)
{
    double norm = 0;
    for (const auto& [tag, field] : fields) {
        norm = std::max(norm, field.norm());
    }
    return norm;
}

void expectSame(const std::map<int, Vector3>& a, const std::map<int, Vector3>& b, double tolerance)
{
    ASSERT_EQ(a.size(), b.size());
    const double scale = largest(b);
    EXPECT_GT(scale, 0);
    for (const auto& [tag, field] : a) {
        EXPECT_LT((field - b.at(tag)).norm(), tolerance * scale) << "tag " << tag;
    }
}

DemParticles manyParticles() { return randomParticles(150, box, 1e-3, 1e-11, Charges::random, 11); }

class EveryMethod : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(FieldMethod, EveryMethod, testing::ValuesIn(FieldMethod::names()),
                         [](const auto& method) { return method.param; });

TEST_P(EveryMethod, givesTheSameFieldOnAnyNumberOfRanks)
{
    const auto parallel = fieldOf(settingsOf(GetParam()), manyParticles(), MPI_COMM_WORLD);
    const auto serial = fieldOf(settingsOf(GetParam()), manyParticles(), MPI_COMM_SELF);
    expectSame(parallel, serial, GetParam() == "pairwiseSum" ? 1e-14 : 1e-12);
}

TEST_P(EveryMethod, isLinearInTheCharges)
{
    DemParticles first = manyParticles();
    DemParticles second = first;
    second.charge = first.charge.reverse().eval();
    DemParticles both = first;
    both.charge = 2 * first.charge - 3 * second.charge;
    const auto fieldOfFirst = fieldOf(settingsOf(GetParam()), first, MPI_COMM_WORLD);
    const auto fieldOfSecond = fieldOf(settingsOf(GetParam()), second, MPI_COMM_WORLD);
    std::map<int, Vector3> sum;
    for (const auto& [tag, field] : fieldOfFirst) {
        sum[tag] = 2 * field - 3 * fieldOfSecond.at(tag);
    }
    expectSame(fieldOf(settingsOf(GetParam()), both, MPI_COMM_WORLD), sum, 1e-13);
}

TEST_P(EveryMethod, doesNotDependOnTheOrderOfTheParticles)
{
    const DemParticles all = manyParticles();
    std::vector<Index> order(static_cast<std::size_t>(all.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    DemParticles shuffled = all;
    for (std::size_t n = 0; n < order.size(); ++n) {
        shuffled.tag[n] = all.tag[static_cast<std::size_t>(order[n])];
    }
    shuffled.position = all.position(order, Eigen::all);
    shuffled.charge = all.charge(order);
    expectSame(fieldOf(settingsOf(GetParam()), shuffled, MPI_COMM_WORLD), fieldOf(settingsOf(GetParam()), all, MPI_COMM_WORLD),
               1e-13);
}

TEST_P(EveryMethod, addsTheExternalField)
{
    FieldSettings settings = settingsOf(GetParam());
    const auto without = fieldOf(settings, manyParticles(), MPI_COMM_WORLD);
    settings.externalField = Vector3(1e4, -2e5, 3e4);
    auto with = fieldOf(settings, manyParticles(), MPI_COMM_WORLD);
    for (auto& [tag, field] : with) {
        field -= settings.externalField;
    }
    expectSame(with, without, 1e-13);
}

TEST_P(EveryMethod, namesTwoParticlesAtTheSamePosition)
{
    DemParticles all = manyParticles();
    all.position.row(90) = all.position.row(17);  // tags 18 and 91, on different ranks when there are two
    const std::string text = textThrownOnAllRanks(MPI_COMM_WORLD, [&] { fieldOf(settingsOf(GetParam()), all, MPI_COMM_WORLD); });
    expectContains(text, "particle 18 and ");
    expectContains(text, "at the same position, (");
}

TEST_P(EveryMethod, runsWithoutAnyParticle)
{
    EXPECT_TRUE(fieldOf(settingsOf(GetParam()), emptyParticles(0), MPI_COMM_WORLD).empty());
}

TEST_P(EveryMethod, countsEveryPairOnceForEachOfItsTwoParticles)
{
    PhaseTimes times;
    BoxMesh mesh(box, cells, epsilon0, MPI_COMM_WORLD);
    const auto method = FieldMethod::create(settingsOf(GetParam()), &mesh, box, open, MPI_COMM_WORLD, times);
    // Farther from the walls than a cloud reaches, so that there are no images.
    const auto* p3m = dynamic_cast<const P3m*>(method.get());
    const double reach = p3m ? p3m->cloudRadius() : method->partnerCutoff();
    const DemParticles all = randomParticles(150, box.grownBy(-5.1e-3), 1e-3, 1e-11, Charges::random, 11);
    // The cell methods pair by whole cells.
    const bool touching = GetParam() == "himCell";
    const bool byCentroids = GetParam() == "hybridParticleCell";
    const auto isNear = [&](Index i, Index k) {
        const auto cell = [](double x) { return std::floor(x / 2.5e-3); };
        const Vector3 a = all.position.row(i).unaryExpr(cell).matrix().transpose();
        const Vector3 b = all.position.row(k).unaryExpr(cell).matrix().transpose();
        if (touching) {
            return (a - b).cwiseAbs().maxCoeff() <= 1;
        }
        return byCentroids ? 2.5e-3 * (a - b).norm() <= 6e-3
                           : (all.position.row(i) - all.position.row(k)).matrix().norm() <= reach;
    };
    std::int64_t expected = 0;
    for (Index i = 0; i < all.size(); ++i) {
        for (Index k = 0; k < all.size(); ++k) {
            expected += i != k && isNear(i, k);
        }
    }
    ParticleField result;
    method->compute(dealt(all, MPI_COMM_WORLD), result);
    EXPECT_EQ(result.pairs, expected);
    EXPECT_EQ(result.excludedCount, 0);
    EXPECT_GT(times.seconds(Phase::near), 0);
}

TEST(PairwiseSum, givesFieldPotentialAndEnergyOfTwoCharges)
{
    DemParticles two = emptyParticles(2);
    two.position.row(1) << 3e-3, 4e-3, 0;  // 5 mm apart
    two.charge << 2e-12, -3e-12;
    FieldSettings settings = settingsOf("pairwiseSum");
    settings.externalField = Vector3(0, 0, 7);
    two.position(1, 2) = 0;
    two.position(0, 2) = 0;
    PhaseTimes times;
    const auto method = FieldMethod::create(settings, nullptr, box, open, MPI_COMM_WORLD, times);
    const DemParticles mine = dealt(two, MPI_COMM_WORLD);
    ParticleField result;
    method->compute(mine, result);
    const double coulomb = 1 / (4 * pi * epsilon0);
    for (Index row = 0; row < mine.size(); ++row) {
        const bool first = mine.tag[static_cast<std::size_t>(row)] == 1;
        const double other = first ? -3e-12 : 2e-12;
        const Vector3 away = Vector3(0.6, 0.8, 0) * (first ? -1 : 1);
        const Vector3 field = coulomb * other / 25e-6 * away + settings.externalField;
        EXPECT_LT((result.field.row(row).matrix().transpose() - field).norm(), 1e-13 * field.norm());
        EXPECT_NEAR(result.potential[row], coulomb * other / 5e-3, 1e-13 * coulomb * 3e-12 / 5e-3);
    }
    double energy = result.energy;
    MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_NEAR(energy, -coulomb * 6e-24 / 5e-3, 1e-13 * coulomb * 6e-24 / 5e-3);
}

TEST(DirectTruncation, equalsPairwiseSumWhenTheCutoffHoldsAllPairs)
{
    FieldSettings truncated = settingsOf("directTruncation");
    truncated.nearCutoff = 1.01 * box.size().norm();
    expectSame(fieldOf(truncated, manyParticles(), MPI_COMM_WORLD),
               fieldOf(settingsOf("pairwiseSum"), manyParticles(), MPI_COMM_WORLD), 1e-13);
}

TEST(DirectTruncation, seesTheNearestChargeThroughAPeriodicFace)
{
    DemParticles two = emptyParticles(2);
    two.position << 1e-3, 0.01, 0.01,  //
        0.04 - 1e-3, 0.01, 0.01;
    two.charge << 1e-12, 1e-12;
    PhaseTimes times;
    const auto method =
        FieldMethod::create(settingsOf("directTruncation"), nullptr, box, {true, false, false}, MPI_COMM_WORLD, times);
    const DemParticles mine = dealt(two, MPI_COMM_WORLD);
    ParticleField result;
    method->compute(mine, result);
    const double strength = 1e-12 / (4 * pi * epsilon0 * 4e-6);
    for (Index row = 0; row < mine.size(); ++row) {
        const double expected = mine.tag[static_cast<std::size_t>(row)] == 1 ? strength : -strength;
        EXPECT_NEAR(result.field(row, 0), expected, 1e-11 * strength);
    }
}

// --- refusals

std::string complaintOf(const FieldSettings& settings, const PoissonMesh* mesh, const std::array<bool, 3>& periodic)
{
    return FieldMethod::check(settings, mesh, box, periodic).text();
}

TEST(FieldMethod, listsItsNamesWhenOneIsUnknown)
{
    PhaseTimes times;
    const std::string text = textThrownOnAllRanks(MPI_COMM_WORLD, [&] {
        FieldMethod::create(settingsOf("hmi"), nullptr, box, open, MPI_COMM_WORLD, times);
    });
    expectContains(text, "electrostaticProperties.fieldMethod: unknown field method \"hmi\"; known: pairwiseSum, "
                         "directTruncation, hybridParticleCell, him, himCell, p3m");
    EXPECT_THROW(FieldMethod::needsMesh("hmi"), std::invalid_argument);
}

TEST(FieldMethod, knowsWhatEachMethodNeeds)
{
    EXPECT_FALSE(FieldMethod::needsMesh("pairwiseSum"));
    EXPECT_FALSE(FieldMethod::needsMesh("directTruncation"));
    EXPECT_TRUE(FieldMethod::needsMesh("him"));
    EXPECT_TRUE(FieldMethod::needsMesh("himCell"));
    EXPECT_TRUE(FieldMethod::needsMesh("hybridParticleCell"));
    EXPECT_FALSE(FieldMethod::needsCutoff("himCell"));
    EXPECT_TRUE(FieldMethod::needsCutoff("hybridParticleCell"));
    EXPECT_FALSE(FieldMethod::needsCutoff("pairwiseSum"));
    EXPECT_TRUE(FieldMethod::needsCutoff("directTruncation"));
    EXPECT_TRUE(FieldMethod::needsCutoff("him"));
}

TEST(FieldMethod, refusesACutoffBelowTheLargestCellDiagonalWithBothNumbers)
{
    const BoxMesh mesh(box, {40, 30, 20}, epsilon0, MPI_COMM_WORLD);  // 1 mm cells, diagonal 1.73205 mm
    FieldSettings settings = settingsOf("him");
    settings.nearCutoff = 1.5e-3;
    const std::string text = complaintOf(settings, &mesh, open);
    expectContains(text, "electrostaticProperties.himCoeffs.nearCutoff: 0.0015 m is below the largest cell diagonal, "
                         "0.00173205 m");
    expectContains(text, "Use at least 0.00173205");
    settings.nearCutoff = mesh.largestCellDiagonal() * (1 - 1e-10);  // equal up to rounding
    EXPECT_TRUE(FieldMethod::check(settings, &mesh, box, open).none());
    settings.nearCutoff = mesh.largestCellDiagonal() * (1 - 1e-8);
    EXPECT_FALSE(FieldMethod::check(settings, &mesh, box, open).none());
    settings.method = "directTruncation";  // a mesh that it does not use sets no limit
    EXPECT_TRUE(FieldMethod::check(settings, &mesh, box, open).none());
}

TEST(FieldMethod, refusesAPairwiseSumInAPeriodicBoxWithAReason)
{
    expectContains(complaintOf(settingsOf("pairwiseSum"), nullptr, {false, true, false}),
                   "in a periodic DEM box every charge has infinitely many copies");
}

TEST(FieldMethod, refusesACutoffLongerThanThePeriodicBox)
{
    FieldSettings settings = settingsOf("directTruncation");
    settings.nearCutoff = 0.035;
    EXPECT_TRUE(FieldMethod::check(settings, nullptr, box, {true, false, false}).none());
    expectContains(complaintOf(settings, nullptr, {true, true, false}),
                   "directTruncationCoeffs.nearCutoff: 0.035 m is longer than the periodic DEM box in y, 0.03 m");
}

TEST(FieldMethod, refusesHimWithoutAMesh)
{
    expectContains(complaintOf(settingsOf("him"), nullptr, open), "him needs a mesh, and the case has none");
}

TEST(FieldMethod, reportsAllComplaintsTogether)
{
    FieldSettings settings = settingsOf("him");
    settings.nearCutoff = -1;
    settings.permittivity = 0;
    const Complaints complaints = FieldMethod::check(settings, nullptr, box, open);
    EXPECT_EQ(complaints.lines().size(), 3u);
    expectContains(complaints.text(), "relativePermittivity: a permittivity of 0 F/m is not positive");
    expectContains(complaints.text(), "himCoeffs.nearCutoff: -1 m is not a positive length");
}

}  // namespace
/// Field of one charge of 4 pi eps0 C by the pair sum with images in these planes, each through the origin with this normal.
ParticleField imageField(const Vector3& place, const std::vector<Vector3>& normals, bool ownResponse = true)
{
    FieldSettings settings = settingsOf("pairwiseSum");
    settings.pairwiseSum.images = true;
    settings.ownResponse = ownResponse;
    for (const Vector3& normal : normals) {
        settings.pairwiseSum.imageWalls.push_back({"wall", ImageWall::Shape::plane, Vector3::Zero(), normal, 0});
    }
    DemParticles one = emptyParticles(1);
    one.position.row(0) = place.transpose().array();
    one.charge[0] = 4 * pi * epsilon0;
    PhaseTimes times;
    ParticleField result;
    FieldMethod::create(settings, nullptr, box, open, MPI_COMM_SELF, times)->compute(one, result);
    return result;
}

TEST(PairwiseSum, pullsAChargeToAGroundedPlaneEdgeAndCornerByItsImages)
{
    const double a = 0.3;
    const Vector3 place(a, a, a);
    const Vector3 x = -Vector3::UnitX(), y = -Vector3::UnitY(), z = -Vector3::UnitZ();
    // q^2/(16 pi eps0 a^2), and the sums over 3 and 7 images by hand
    const double edge = -1 / (4 * a * a) * (1 - 1 / (2 * std::sqrt(2.0)));
    const double corner = -1 / (4 * a * a) * (1 - 2 / (2 * std::sqrt(2.0)) + 1 / (3 * std::sqrt(3.0)));
    EXPECT_LT((imageField(place, {x}).field.row(0).matrix().transpose() - Vector3(-1 / (4 * a * a), 0, 0)).norm(), 1e-12);
    EXPECT_LT((imageField(place, {x, y}).field.row(0).matrix().transpose() - Vector3(edge, edge, 0)).norm(), 1e-12);
    const ParticleField result = imageField(place, {x, y, z});
    EXPECT_LT((result.field.row(0).matrix().transpose() - Vector3::Constant(corner)).norm(), 1e-12);
    EXPECT_LT((result.ownResponse - result.field).matrix().norm(), 1e-12);
    EXPECT_EQ(result.pairs, 7);
}

TEST(PairwiseSum, leavesOutTheOwnResponseWhereNothingNeedsIt)
{
    const ParticleField result = imageField(Vector3(0.3, 0.3, 0.3), {-Vector3::UnitX()}, false);
    EXPECT_EQ(result.ownResponse.rows(), 0);
    EXPECT_GT(result.field.matrix().norm(), 0);
}

TEST(PairwiseSum, leavesOutPairsBeyondItsTruncation)
{
    DemParticles three = emptyParticles(3);
    three.position.row(1) << 3e-3, 0, 0;
    three.position.row(2) << 0, 9e-3, 0;
    three.charge.setConstant(1e-12);
    FieldSettings settings = settingsOf("pairwiseSum");
    settings.pairwiseSum.truncation = 5e-3;
    PhaseTimes times;
    ParticleField result;
    FieldMethod::create(settings, nullptr, box, open, MPI_COMM_SELF, times)->compute(three, result);
    EXPECT_EQ(result.pairs, 2);
    EXPECT_EQ(result.field.row(2).matrix().norm(), 0);
    EXPECT_NEAR(result.field(1, 0), 1e-12 / (4 * pi * epsilon0 * 9e-6), 1e-9);
}

TEST(Settings, ofP3mAreRefusedTogetherWithTheAllowedValues)
{
    const BoxMesh mesh(box, cells, epsilon0, MPI_COMM_SELF);
    FieldSettings settings = settingsOf("p3m");
    EXPECT_TRUE(FieldMethod::check(settings, &mesh, box, open).none());
    settings.p3m.cloudCells = 1.5;
    settings.p3m.cloudExponent = 3;
    const std::string text = FieldMethod::check(settings, &mesh, box, open).text();
    expectContains(text, "p3mCoeffs.cloudCells: a cloud radius of 1.5 cells is too small");
    expectContains(text, "Use at least 1.75");
    expectContains(text, "p3mCoeffs.cloudExponent: 3 is not known; known: 1, 2");
    settings = settingsOf("p3m");
    settings.p3m.cloudRadius = 0.05;
    expectContains(FieldMethod::check(settings, &mesh, box, {true, false, false}).text(),
                   "p3mCoeffs.cloudRadius: 0.05 m is longer than the periodic DEM box in x, 0.04 m");
}

}  // namespace him
