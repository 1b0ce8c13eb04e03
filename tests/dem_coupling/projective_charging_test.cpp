// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/projective_charging.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace him {
namespace {

Scalars charges(std::initializer_list<double> values)
{
    Scalars result(static_cast<Index>(values.size()));
    std::copy(values.begin(), values.end(), result.begin());
    return result;
}

/// One rank's bed where every particle relaxes to q* = 1: the burst leaves 1 + (q - 1) exp(-x).
Scalars relaxed(const Scalars& charge, double x)
{
    return 1 + (charge - 1) * std::exp(-x);
}

TEST(ChargeProjection, relaxesTowardsTheChargeAtWhichNothingMovesAndNeverPassesIt)
{
    const Scalars before = charges({0, 0.2, 0.5, 1.4});
    const Scalars after = relaxed(before, 1e-4);
    const ChargeProjection projection(before, after, MPI_COMM_SELF);
    EXPECT_TRUE(projection.relaxes());
    EXPECT_NEAR(-projection.gainAtZero() / projection.slope(), 1, 1e-9);
    for (const double bursts : {1.0, 1e3, 1e4, 1e7}) {
        const Scalars projected = projection.project(after, bursts);
        const Scalars exact = relaxed(after, 1e-4 * bursts);
        for (Index n = 0; n < after.size(); ++n) {
            EXPECT_NEAR(projected[n], exact[n], 1e-3 * std::abs(after[n] - 1)) << bursts;
            // Of the other side of the equilibrium there is round-off at most.
            EXPECT_GE((projected[n] - 1) * (after[n] - 1), -1e-11) << bursts;
            EXPECT_LE(std::abs(projected[n] - 1), std::abs(after[n] - 1)) << bursts;
        }
    }
}

TEST(ChargeProjection, keepsTheSumOfParticlesAndWall)
{
    const Scalars before = charges({0, 0.2, 0.5, 1.4});
    const Scalars after = relaxed(before, 0.01);
    const double wallGain = -(after - before).sum();
    const ChargeProjection projection(before, after, MPI_COMM_SELF);
    const Scalars projected = projection.project(after, 57);
    const double more = wallGain * projection.wallFactor(after, 57, MPI_COMM_SELF);
    EXPECT_NEAR(projected.sum() + wallGain + more, before.sum(), 1e-12);
}

TEST(ChargeProjection, goesOnWithTheMeanWhereChargesDoNotRelax)
{
    const Scalars before = charges({0, 1, 2});
    const Scalars after = charges({1, 3, 5});  // the more charge, the more gain
    const ChargeProjection projection(before, after, MPI_COMM_SELF);
    EXPECT_FALSE(projection.relaxes());
    const Scalars projected = projection.project(after, 3);
    EXPECT_NEAR(projected[0], 1 + 3 * 2, 1e-12);
    EXPECT_NEAR(projected[2], 5 + 3 * 2, 1e-12);
    const ChargeProjection equal(charges({1, 1, 1}), charges({1, 1, 2.5}), MPI_COMM_SELF);
    EXPECT_NEAR(equal.project(charges({1, 1, 2.5}), 2)[0], 2, 1e-12);
}

TEST(ChargeProjection, doesNothingWhenTheBurstMovedNothingAndRefusesNonsense)
{
    const Scalars still = charges({1, 2, 3});
    const ChargeProjection projection(still, still, MPI_COMM_SELF);
    EXPECT_EQ((projection.project(still, 100) - still).abs().maxCoeff(), 0);
    EXPECT_EQ(projection.wallFactor(still, 100, MPI_COMM_SELF), 0);
    EXPECT_THROW(projection.project(still, -1), std::invalid_argument);
    EXPECT_THROW(ChargeProjection(still, charges({1}), MPI_COMM_SELF), std::invalid_argument);
}

TEST(ChargeProjection, errorIsTheShareByWhichTheGainWasMisjudged)
{
    EXPECT_EQ(projectionError(2, 2), 0);
    EXPECT_NEAR(projectionError(2, 1), 0.5, 1e-15);
    EXPECT_NEAR(projectionError(-1, 1), 2, 1e-15);
    EXPECT_EQ(projectionError(0, 0), 0);
}

/// A well mixed bed: in every step each particle has the same chance to touch the wall and then gains x (1 - q). What true
/// charging, projection and acceleration make of mean and spread after the same simulated time.
struct Moments {
    double mean, spread;
};

Moments momentsOf(const Scalars& charge)
{
    const double mean = charge.mean();
    return {mean, std::sqrt((charge - mean).square().mean())};
}

class MixedBed {
public:
    explicit MixedBed(unsigned seed) : random_(seed), charge(Scalars::Zero(2000)) {}

    void step(double x)
    {
        for (Index n = 0; n < charge.size(); ++n) {
            if (chance_(random_) < 0.02) {
                charge[n] += -std::expm1(-x) * (1 - charge[n]);
            }
        }
    }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<double> chance_{0, 1};

public:
    Scalars charge;
};

TEST(ChargeProjection, keepsTheMeanOfAMixedBedAndNarrowsTheSpreadWhereAccelerationWidensIt)
{
    constexpr double x = 0.01;  // share of the way to equilibrium per wall contact
    constexpr int steps = 4000;
    MixedBed plain(1);
    for (int n = 0; n < steps; ++n) {
        plain.step(x);
    }
    MixedBed accelerated(1);
    for (int n = 0; n < steps / 10; ++n) {
        accelerated.step(10 * x);
    }
    MixedBed projected(1);
    for (int n = 0; n < steps; n += 1000) {  // a tenth in bursts: 100 steps of burst, then 900 projected
        const Scalars before = projected.charge;
        for (int k = 0; k < 100; ++k) {
            projected.step(x);
        }
        projected.charge = ChargeProjection(before, projected.charge, MPI_COMM_SELF).project(projected.charge, 9);
    }
    const Moments exact = momentsOf(plain.charge), fast = momentsOf(accelerated.charge), ours = momentsOf(projected.charge);
    EXPECT_NEAR(ours.mean / exact.mean, 1, 0.05);
    EXPECT_GT(fast.spread, 2.5 * exact.spread);  // sqrt(10) by the number of contacts
    // The projection knows the mean gain at a charge only, so what chance contacts add to the spread is lost while it lasts.
    EXPECT_LT(ours.spread, exact.spread);
    EXPECT_GT(ours.spread, 0.2 * exact.spread);
    std::printf("mean and spread: plain %.4f %.4f, accelerated %.4f %.4f, projected %.4f %.4f\n", exact.mean, exact.spread,
                fast.mean, fast.spread, ours.mean, ours.spread);
}

}  // namespace
}  // namespace him
