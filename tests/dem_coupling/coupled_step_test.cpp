// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/compensated_sum.hpp"
#include "dem_coupling/coupled_step.hpp"
#include "electrostatics/constants.hpp"
#include "tests/support/collective_throw.hpp"
#include "tests/support/fake_dem.hpp"
#include "tests/support/particle_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace him {
namespace {

const Box box{Vector3::Constant(-0.05), Vector3::Constant(0.05)};
constexpr std::array<bool, 3> open{false, false, false};
constexpr double timeStep = 1e-5;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A field method that a test can spoil; costs nothing with many particles.
class NoField : public FieldMethod {
public:
    void compute(const DemParticles& particles, ParticleField& result) override
    {
        result.field.setZero(particles.size(), 3);
        for (Index row = 0; row < particles.size(); ++row) {
            if (particles.tag[static_cast<std::size_t>(row)] == spoiledTag) {
                result.field(row, 1) = nan;
            }
        }
    }
    double partnerCutoff() const override { return 0.25; }
    bool hasPotential() const override { return false; }
    int spoiledTag = 0;
};

std::unique_ptr<FieldMethod> pairwiseSum(PhaseTimes& times, const Vector3& externalField = Vector3::Zero())
{
    FieldSettings settings;
    settings.method = "pairwiseSum";
    settings.permittivity = epsilon0;
    settings.externalField = externalField;
    return FieldMethod::create(settings, nullptr, box, open, MPI_COMM_WORLD, times);
}

/// A DEM with `all` dealt over the ranks, coupled to a method.
struct Scene {
    explicit Scene(const DemParticles& all)
        : dem(dealt(all, MPI_COMM_WORLD), box, open, timeStep, MPI_COMM_WORLD), step(dem, none, MPI_COMM_WORLD, times)
    {
    }
    /// Row of a tag on this rank, or -1.
    Index rowOf(int tag) const
    {
        const auto found = std::find(dem.mine.tag.begin(), dem.mine.tag.end(), tag);
        return found == dem.mine.tag.end() ? -1 : found - dem.mine.tag.begin();
    }
    void take(int tag)
    {
        dem.mine = select(dem.mine, [&](Index row) { return dem.mine.tag[static_cast<std::size_t>(row)] != tag; });
        dem.heldField.setZero(dem.mine.size(), 3);
    }
    std::string advanceUntilItThrows()
    {
        return textThrownOnAllRanks(MPI_COMM_WORLD, [&] { step.advance(1); });
    }

    PhaseTimes times;
    NoField none;
    FakeDem dem;
    CoupledStep step;
};

DemParticles twelve()
{
    DemParticles all = randomParticles(12, box, 1e-3, 1e-9, Charges::random, 31);
    for (Index row = 0; row < all.size(); ++row) {
        all.velocity.row(row) << 0.25 * static_cast<double>(row + 1), 0, -1;
    }
    return all;
}

TEST(CoupledStep, computesAFieldBeforeItHandsOver)
{
    Scene scene(twelve());
    scene.step.start();
    EXPECT_TRUE(scene.dem.handedOver);
    EXPECT_EQ(scene.dem.fieldsSet, 1);
    EXPECT_EQ(scene.dem.partnerCutoff, 0.25);
    scene.step.advance(10);
    scene.step.advance(10);
    EXPECT_EQ(scene.dem.fieldsSet, 3);
}

TEST(CoupledStep, summarisesTheParticlesOfAllRanks)
{
    DemParticles all = emptyParticles(3);
    all.position << 0, 0, 0,  //
        3e-3, 4e-3, 0,        //
        -0.02, 0, 0;
    all.charge << 2e-12, -3e-12, 0;
    all.velocity.row(2) << 3, 0, 4;
    PhaseTimes times;
    const auto method = pairwiseSum(times);
    FakeDem dem(dealt(all, MPI_COMM_WORLD), box, open, timeStep, MPI_COMM_WORLD);
    CoupledStep step(dem, *method, MPI_COMM_WORLD, times);
    step.start();
    const StepSummary& summary = step.summary();
    const double coulomb = 1 / (4 * pi * epsilon0);
    EXPECT_EQ(summary.particles, 3);
    EXPECT_NEAR(summary.totalCharge, -1e-12, 1e-26);
    EXPECT_EQ(summary.smallestCharge, -3e-12);
    EXPECT_EQ(summary.largestCharge, 2e-12);
    EXPECT_NEAR(summary.largestField, coulomb * 3e-12 / 25e-6, 1e-9 * summary.largestField);
    EXPECT_NEAR(summary.energy, -coulomb * 6e-24 / 5e-3, 1e-12 * std::fabs(summary.energy));
    EXPECT_NEAR(summary.kineticEnergy, 0.5 * 1e-6 * 25, 1e-18);
    EXPECT_EQ(summary.excludedCount, 0);
}

TEST(CoupledStep, knowsHowFastTheFieldOfTouchingChargesChanges)
{
    // Two unlike spheres in contact: the force k q^2/x^2 on the reduced mass m/2 has the slope 2 k q^2/(2 r)^3.
    const double q = 1e-11, m = 2e-8, r = 1e-4;
    DemParticles pair = emptyParticles(2);
    pair.position.row(0) << -r, 0, 0;
    pair.position.row(1) << r, 0, 0;
    pair.charge << q, -q;
    pair.mass.setConstant(m);
    pair.radius.setConstant(r);
    PhaseTimes times;
    const auto method = pairwiseSum(times);
    FakeDem dem(dealt(pair, MPI_COMM_WORLD), box, open, timeStep, MPI_COMM_WORLD);
    CoupledStep step(dem, *method, MPI_COMM_WORLD, times);
    step.start();
    const double slope = 2 * q * q / (4 * pi * epsilon0) / std::pow(2 * r, 3);
    EXPECT_NEAR(step.summary().fieldFrequency / std::sqrt(slope / (m / 2)), 1, 1e-12);
}

TEST(CoupledStep, conservesEnergyInAnExternalField)
{
    // Charge q in the field E from rest, semi-implicit Euler with one field per step: kinetic energy plus -q E.x is
    // exactly -m a^2 dt^2 n/2 after n steps.
    DemParticles one = emptyParticles(1);
    one.charge[0] = 2e-9;
    PhaseTimes times;
    const auto method = pairwiseSum(times, Vector3(0, 5e3, 0));
    FakeDem dem(dealt(one, MPI_COMM_WORLD), box, open, timeStep, MPI_COMM_WORLD);
    CoupledStep step(dem, *method, MPI_COMM_WORLD, times);
    step.start();
    for (int n = 0; n < 50; ++n) {
        step.advance(2);
    }
    const double acceleration = 2e-9 * 5e3 / 1e-6;
    const double drift = -0.5 * 1e-6 * std::pow(acceleration * timeStep, 2) * 100;
    EXPECT_NEAR(step.summary().kineticEnergy, 0.5 * 1e-6 * std::pow(acceleration * timeStep * 100, 2), 1e-18);
    EXPECT_NEAR(step.summary().kineticEnergy + step.summary().energy, drift, 1e-6 * std::fabs(drift));
}

TEST(CoupledStep, namesALostParticleWithItsLastPositionAndVelocity)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] { scene.take(7); };
    const auto before = gatherByTag(scene.dem.mine.tag, scene.dem.mine.position, MPI_COMM_WORLD);
    const std::string text = scene.advanceUntilItThrows();
    std::ostringstream place;
    place << '(' << before.at(7)[0] << ' ' << before.at(7)[1] << ' ' << before.at(7)[2] << ')';
    expectContains(text, "the DEM believes to have 12 particles, and 11 are there");
    expectContains(text, "missing: particle 7, last at " + place.str() + " m with velocity (1.75 0 -1) m/s");
    expectContains(text, "`timestep`");
    expectContains(text, "walls");
    expectContains(text, "`boundary`");
    EXPECT_EQ(text.find("particle 8"), std::string::npos);
}

TEST(CoupledStep, namesTenLostParticlesAndCountsTheRest)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] {
        for (int tag = 1; tag <= 12; ++tag) {
            scene.take(tag);
        }
    };
    const std::string text = scene.advanceUntilItThrows();
    expectContains(text, "missing: particle 10,");
    expectContains(text, "and 2 more");
}

TEST(CoupledStep, acceptsParticlesThatTheDemItselfTakesOutAndPutsIn)
{
    const DemParticles all = twelve();
    Scene scene(all);
    scene.step.start();
    scene.dem.duringRun = [&] {
        scene.take(7);
        scene.dem.believedCount = 11;
        scene.dem.moved.removed = all.charge[6];
    };
    EXPECT_NO_THROW(scene.step.advance(1));
    EXPECT_EQ(scene.step.summary().particles, 11);
    EXPECT_NEAR(scene.step.books().relativeClosureError(), 0, 1e-15);
}

TEST(CoupledStep, stopsWhenAParticleLeavesWithChargeThatNoBookHolds)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] {
        scene.take(7);
        scene.dem.believedCount = 11;
    };
    expectContains(scene.advanceUntilItThrows(), "the charge books do not close");
}

TEST(CoupledStep, namesAParticleWhosePositionIsNotANumber)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] {
        for (const int tag : {5, 9}) {
            if (scene.rowOf(tag) >= 0) {
                scene.dem.mine.position(scene.rowOf(tag), 2) = nan;
            }
        }
    };
    const std::string text = scene.advanceUntilItThrows();
    expectContains(text, "particle 5: its position is not a finite number");
    expectContains(text, "at the last field update it was at (");
    expectContains(text, "`timestep`");
}

TEST(CoupledStep, namesAParticleWhoseVelocityIsInfinite)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] {
        if (scene.rowOf(4) >= 0) {
            scene.dem.mine.velocity(scene.rowOf(4), 0) = -std::numeric_limits<double>::infinity();
        }
    };
    expectContains(scene.advanceUntilItThrows(), "particle 4: its velocity is not a finite number");
}

TEST(CoupledStep, namesAParticleWhoseChargeIsNotANumberAndTheSettingsThatCanCauseIt)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] {
        if (scene.rowOf(12) >= 0) {
            scene.dem.mine.charge[scene.rowOf(12)] = nan;
        }
    };
    const std::string text = scene.advanceUntilItThrows();
    expectContains(text, "particle 12: its charge is not a finite number");
    expectContains(text, "gamma and kappa");
}

TEST(CoupledStep, namesAParticleWhoseFieldIsNotANumberAndHandsNothingOver)
{
    Scene scene(twelve());
    scene.step.start();
    scene.none.spoiledTag = 3;
    const std::string text = scene.advanceUntilItThrows();
    expectContains(text, "particle 3 at (");
    expectContains(text, "is not finite. Check the boundary values of 0/electricPotential");
    EXPECT_EQ(scene.dem.fieldsSet, 1);
}

TEST(CoupledStep, stopsWhenAChargeIsFaked)
{
    Scene scene(twelve());
    scene.step.start();
    scene.dem.duringRun = [&] {
        if (scene.rowOf(2) >= 0) {
            scene.dem.mine.charge[scene.rowOf(2)] += 1e-15;
        }
    };
    expectContains(scene.advanceUntilItThrows(), "the charge books do not close");
}

TEST(CoupledStep, closesTheBooksToRoundOffWithManyParticles)
{
    const int count = 200000;
    DemParticles all = emptyParticles(count);
    all.charge.setConstant(0.1);  // no binary fraction: a plain running sum is off by 1e-12 and more
    Scene scene(all);
    scene.dem.wallList.resize(1);
    scene.dem.moved.toWall = {0};
    scene.step.start();
    EXPECT_NEAR(scene.step.summary().totalCharge, 0.1 * count, 1e-15 * 0.1 * count);
    std::mt19937 random(7);
    CompensatedSum given;
    scene.dem.duringRun = [&] {
        CompensatedSum mine;
        for (double& charge : scene.dem.mine.charge) {
            const double next = charge + 1e-3 * static_cast<double>(random()) / 4294967296.0;
            mine += charge;
            mine += -next;
            charge = next;
        }
        double moved = mine.value();
        MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
        given += moved;
        scene.dem.moved.toWall[0] = given.value();
    };
    for (int n = 0; n < 5; ++n) {
        scene.step.advance(1);
        EXPECT_LT(std::fabs(scene.step.books().relativeClosureError()), 1e-14);
    }
    EXPECT_GT(std::fabs(scene.step.books().movements().toWall[0]), 100.0);
}

}  // namespace
}  // namespace him
