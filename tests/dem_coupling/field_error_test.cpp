// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_error.hpp"
#include "dem_coupling/field_error/box_of_mesh.hpp"
#include "electrostatics/constants.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/collective_throw.hpp"
#include "tests/support/packings.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

constexpr std::array<bool, 3> open{false, false, false};
const MPI_Comm world = MPI_COMM_WORLD;

FieldSettings settingsOf(const std::string& method)
{
    FieldSettings settings;
    settings.method = method;
    settings.permittivity = epsilon0;
    settings.externalField = Vector3(1e3, -2e3, 5e2);
    return settings;
}

/// Spheres of 1 mm with +-1 pC in a cube of 24 mm, dealt over the ranks, and a mesh of 2 mm.
struct Scene24 {
    Packing packing = makePacking(Scene::dilute, 24, Signs::random, 1, 1e-3, 1e-12);
    DemParticles all, mine;
    BoxMesh mesh{packing.box, {12, 12, 12}, epsilon0, world};

    Scene24()
    {
        all = emptyParticles(static_cast<int>(packing.charge.size()));
        all.position = packing.position;
        all.charge = packing.charge;
        mine = dealt(all, world);
    }

    /// Field of this rank's particles by a method, external field included.
    Points fieldBy(const FieldSettings& settings)
    {
        PhaseTimes times;
        ParticleField result;
        const bool onMesh = FieldMethod::needsMesh(settings.method);
        FieldMethod::create(settings, onMesh ? &mesh : nullptr, packing.box, open, world, times)->compute(mine, result);
        return result.field;
    }
    FieldErrorMonitor monitor(const FieldSettings& settings, FieldErrorSettings errorSettings = {})
    {
        const bool onMesh = FieldMethod::needsMesh(settings.method);
        std::string reason;
        return {errorSettings,
                FieldReference::find(settings, onMesh ? &mesh : nullptr, packing.box, open, world, reason),
                settings.externalField, world};
    }
    /// Exact field of this rank's particles, external field included.
    Points exact(const FieldSettings& settings) const
    {
        Points field;
        Scalars potential;
        GroundedBox(packing.box, epsilon0).compute(all.position, all.charge, field, potential);
        field.rowwise() += settings.externalField.transpose().array();
        Points part(mine.size(), 3);
        for (Index row = 0; row < mine.size(); ++row) {
            part.row(row) = field.row(mine.tag[static_cast<std::size_t>(row)] - 1);
        }
        return part;
    }
};

TEST(FieldError, isNoneForTheExactFieldAndKnownForASpoiltOne)
{
    Scene24 scene;
    const FieldSettings settings = settingsOf("p3m");
    FieldErrorMonitor monitor = scene.monitor(settings);
    Points field = scene.exact(settings);
    FieldError error = monitor.measure(scene.mine, field);
    EXPECT_EQ(error.failure, "");
    EXPECT_LT(error.rms, 1e-6);
    EXPECT_GT(error.sample, 60);
    EXPECT_LT(error.sample, 180);

    // Everything 3 % too large.
    field.rowwise() -= settings.externalField.transpose().array();
    field *= 1.03;
    field.rowwise() += settings.externalField.transpose().array();
    error = monitor.measure(scene.mine, field);
    EXPECT_NEAR(error.rms, 0.03, 1e-6);
    EXPECT_GT(error.largest, error.rms);
    EXPECT_GT(error.seconds, 0);
}

TEST(FieldError, ofASampleIsThatOfAllParticlesAbout)
{
    Scene24 scene;
    for (const char* method : {"him", "p3m"}) {
        FieldSettings settings = settingsOf(method);
        settings.nearCutoff = 3.6e-3;
        const Points field = scene.fieldBy(settings);
        const Points exact = scene.exact(settings);
        std::array<double, 2> squares{(field - exact).square().sum(),
                                      (exact.rowwise() - settings.externalField.transpose().array()).square().sum()};
        MPI_Allreduce(MPI_IN_PLACE, squares.data(), 2, MPI_DOUBLE, MPI_SUM, world);
        const double truth = std::sqrt(squares[0] / squares[1]);

        FieldErrorSettings everybody;
        everybody.sample = 264;
        const FieldError ofAll = scene.monitor(settings, everybody).measure(scene.mine, field);
        EXPECT_EQ(ofAll.sample, 264);
        EXPECT_NEAR(ofAll.rms, truth, 1e-5 * truth) << method;
        const FieldError ofSome = scene.monitor(settings).measure(scene.mine, field);
        EXPECT_LT(ofSome.sample, 264);
        EXPECT_GT(ofSome.rms, 0.4 * truth) << method;
        EXPECT_LT(ofSome.rms, 2.5 * truth) << method;
        EXPECT_LE(ofSome.largest * ofSome.referenceRms, ofAll.largest * ofAll.referenceRms * (1 + 1e-5));
    }
}

TEST(FieldError, ofATruncatedSumWithoutAMeshIsAgainstAllPairs)
{
    Scene24 scene;
    FieldSettings settings = settingsOf("directTruncation");
    settings.nearCutoff = 1;  // m: all pairs
    FieldErrorMonitor monitor = scene.monitor(settings);
    EXPECT_EQ(monitor.reference(), "the sum over all pairs, exact in free space");
    EXPECT_LT(monitor.measure(scene.mine, scene.fieldBy(settings)).rms, 1e-12);
    settings.nearCutoff = 6e-3;
    const FieldError truncated = monitor.measure(scene.mine, scene.fieldBy(settings));
    EXPECT_GT(truncated.rms, 0.1);
    EXPECT_LT(truncated.rms, 2);
}

TEST(FieldError, hasNoReferenceWhereNothingIsExact)
{
    Scene24 scene;
    FieldErrorMonitor monitor = scene.monitor(settingsOf("pairwiseSum"));  // is its own reference
    EXPECT_EQ(monitor.reference(), "");
    EXPECT_FALSE(monitor.due(0, 1));
    EXPECT_NE(monitor.measure(scene.mine, scene.mine.position).failure, "");
}

/// A mesh with matter of which p3m knows nothing.
class MeshWithGlass : public BoxMesh {
public:
    using BoxMesh::BoxMesh;
    bool chargesAlone() const override { return false; }
    std::string unknownToP3m() const override { return "there is glass in it"; }
};

TEST(FieldError, isNotMeasuredByAP3mThatDoesNotKnowAllOfTheMesh)
{
    const Scene24 scene;
    MeshWithGlass mesh(scene.packing.box, {12, 12, 12}, epsilon0, world);
    FieldSettings settings = settingsOf("him");
    settings.nearCutoff = 3.6e-3;
    std::string reason;
    EXPECT_EQ(FieldReference::find(settings, &mesh, scene.packing.box, open, world, reason), nullptr);
    EXPECT_EQ(reason, "a stricter p3m would serve, but there is glass in it");
    EXPECT_TRUE(FieldMethod::check(settings, &mesh, scene.packing.box, open).none());
    expectContains(FieldMethod::check(settingsOf("p3m"), &mesh, scene.packing.box, open).text(),
                   "p3m can not be used here, because there is glass in it");
}

TEST(FieldError, saysOnAllRanksWhyItCouldNotMeasure)
{
    Scene24 scene;
    FieldErrorMonitor monitor = scene.monitor(settingsOf("him"));
    DemParticles particles = scene.mine;
    for (Index row = 0; row < particles.size(); ++row) {
        if (particles.tag[static_cast<std::size_t>(row)] == 17) {
            particles.position(row, 2) = 1;  // far outside; one rank has it
        }
    }
    const FieldError error = monitor.measure(particles, Points::Zero(particles.size(), 3));
    expectContains(error.failure, "is not inside the box");
    DemParticles uncharged = scene.mine;
    uncharged.charge.setZero();
    expectContains(monitor.measure(uncharged, Points::Zero(uncharged.size(), 3)).failure, "no particle of the sample");
    const DemParticles nobody = emptyParticles(0);
    expectContains(monitor.measure(nobody, Points(0, 3)).failure, "no particle of the sample");
}

TEST(FieldError, isMeasuredAtTheIntervalOrWithinItsShareOfTime)
{
    Scene24 scene;
    FieldErrorSettings every7;
    every7.interval = 7;
    FieldErrorMonitor atInterval = scene.monitor(settingsOf("him"), every7);
    for (long update = 0; update < 30; ++update) {
        EXPECT_EQ(atInterval.due(update, 1e-9), update % 7 == 0);
    }
    FieldErrorSettings off;
    off.active = false;
    EXPECT_FALSE(scene.monitor(settingsOf("him"), off).due(0, 1e9));

    FieldErrorMonitor adaptive = scene.monitor(settingsOf("him"));
    EXPECT_TRUE(adaptive.due(0, 0));
    const double seconds = adaptive.measure(scene.mine, scene.exact(settingsOf("him"))).seconds;
    // The first one and a second one of the same length are 2 % of 100 lengths.
    EXPECT_FALSE(adaptive.due(1, 99 * seconds));
    EXPECT_TRUE(adaptive.due(1, 101 * seconds));
}

TEST(BoxOfMesh, isFoundWhereTheMeshIsOne)
{
    Box box;
    box.extend(Vector3(-1, 0, 2));
    box.extend(Vector3(1, 3, 2.5));
    const BoxMesh grounded(box, {4, 6, 2}, epsilon0, world);
    const auto space = boxOfMesh(grounded, open, world);
    ASSERT_TRUE(space);
    EXPECT_LT((space->box.lower - box.lower).norm() + (space->box.upper - box.upper).norm(), 1e-12);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(space->sides.lower[axis], BoxSide::grounded);
        EXPECT_EQ(space->sides.upper[axis], BoxSide::grounded);
    }
    const std::array<bool, 3> alongY{false, true, false};
    const BoxMesh periodic(box, {4, 6, 2}, epsilon0, world, alongY);
    const auto tube = boxOfMesh(periodic, alongY, world);
    ASSERT_TRUE(tube);
    EXPECT_EQ(tube->sides.lower[1], BoxSide::periodic);
    EXPECT_EQ(tube->sides.upper[2], BoxSide::grounded);
}

/// A box mesh with one thing changed in its arrays.
class ChangedMesh : public BoxMesh {
public:
    using BoxMesh::BoxMesh;
    const MeshArrays& arrays() const override { return changed; }
    MeshArrays changed = BoxMesh::arrays();
};

TEST(BoxOfMesh, isNotSeenInOtherMeshes)
{
    Box box;
    box.extend(Vector3(0, 0, 0));
    box.extend(Vector3(1, 1, 1));
    int ranks = 1;
    int rank = 0;
    MPI_Comm_size(world, &ranks);
    MPI_Comm_rank(world, &rank);
    const bool last = rank == ranks - 1;
    const auto found = [&](auto change) {
        ChangedMesh mesh(box, {8, 8, 8}, epsilon0, world);
        if (last) {
            change(mesh.changed);
        }
        return boxOfMesh(mesh, open, world).has_value();
    };
    EXPECT_TRUE(found([](MeshArrays&) {}));
    EXPECT_FALSE(found([](MeshArrays& arrays) { arrays.boundary.value[3] = 5; }));
    EXPECT_FALSE(found([](MeshArrays& arrays) { arrays.boundary.condition[3] = FaceCondition::insulated; }));
    EXPECT_FALSE(found([](MeshArrays& arrays) { arrays.boundary.condition[3] = FaceCondition::other; }));
    EXPECT_FALSE(found([](MeshArrays& arrays) { arrays.boundary.normal.row(3) << 0.6, 0.8, 0; }));
    EXPECT_FALSE(found([](MeshArrays& arrays) { arrays.volume[0] = 0; }));
}

}  // namespace
}  // namespace him
