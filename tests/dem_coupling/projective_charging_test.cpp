// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/projective_charging.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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

ChargeProjection fit(const Scalars& before, const Scalars& after, const std::vector<double>& equilibrium = {},
                     MPI_Comm communicator = MPI_COMM_SELF)
{
    return ChargeProjection(before, after, Scalars::Ones(before.size()),
                            std::vector<int>(static_cast<std::size_t>(before.size()), 0), {equilibrium}, communicator);
}

TEST(ChargeProjection, relaxesTowardsTheChargeAtWhichNothingMovesAndNeverPassesIt)
{
    const Scalars before = charges({0, 0.2, 0.5, 1.4});
    const Scalars after = relaxed(before, 1e-4);
    const ChargeProjection projection = fit(before, after);
    EXPECT_TRUE(projection.groups()[0].fromBurst);
    EXPECT_NEAR(projection.groups()[0].limit(), 1, 1e-9);
    for (const long bursts : {1L, 1000L, 10000L, 10000000L}) {
        const Scalars projected = projection.leap(bursts, 0, true).charge;
        const Scalars exact = relaxed(after, 1e-4 * static_cast<double>(bursts));
        for (Index n = 0; n < after.size(); ++n) {
            EXPECT_NEAR(projected[n], exact[n], 1e-3 * std::abs(after[n] - 1)) << bursts;
            // Of the other side of the equilibrium there is round-off at most.
            EXPECT_GE((projected[n] - 1) * (after[n] - 1), -1e-11) << bursts;
            EXPECT_LE(std::abs(projected[n] - 1), std::abs(after[n] - 1)) << bursts;
        }
    }
}

TEST(ChargeProjection, leapsFromLongBurstsAsFarAsManyOfThemWouldGo)
{
    const Scalars before = charges({0, 0.2, 0.5, 1.4});
    for (const double x : {0.01, 0.3, 2.0}) {
        const Scalars after = relaxed(before, x);
        const Scalars projected = fit(before, after).leap(9, 0, true).charge;
        const Scalars exact = relaxed(after, 9 * x);
        for (Index n = 0; n < after.size(); ++n) {
            EXPECT_NEAR((projected[n] - 1) / (exact[n] - 1), 1, 1e-6) << x;
        }
    }
    // A burst that went past q* has left nothing of the way.
    const Scalars past = 1 - 0.2 * (before - 1);
    EXPECT_NEAR((fit(before, past).leap(3, 0, true).charge - 1).abs().maxCoeff(), 0, 1e-12);
}

TEST(ChargeProjection, goesToTheKnownEquilibriumWhereTheBurstDoesNotShowOne)
{
    const Scalars before = charges({0, 1, 2});
    const Scalars after = charges({1, 3, 5});  // the more charge, the more gain: mean 2 on the way from 1 to 101
    const ChargeProjection projection = fit(before, after, {-50, 101});
    EXPECT_FALSE(projection.groups()[0].fromBurst);
    EXPECT_NEAR(projection.groups()[0].limit(), 101, 1e-10);
    EXPECT_NEAR(projection.groups()[0].slope, -0.02, 1e-15);
    const Scalars far = projection.leap(100000, 0, true).charge;
    EXPECT_LE(far.maxCoeff(), 101);
    EXPECT_NEAR(far.mean(), 101, 2.5);  // the rests leave some of them below it
}

TEST(ChargeProjection, aLimitBeyondTheKnownEquilibriumDoesNotCount)
{
    const Scalars before = charges({0, 0.2, 0.5, 0.7});
    const ChargeProjection projection = fit(before, relaxed(before, 1e-3), {0.8});
    EXPECT_FALSE(projection.groups()[0].fromBurst);
    EXPECT_NEAR(projection.groups()[0].limit(), 0.8, 1e-12);
    EXPECT_LE(projection.leap(1000000, 0, true).charge.maxCoeff(), 0.8 * (1 + 1e-12));
}

TEST(ChargeProjection, restsCarryNothingBeyondTheEquilibriumCharge)
{
    Scalars before(200), after(200);
    std::mt19937 random(3);
    std::normal_distribution<double> scatter;
    for (Index n = 0; n < before.size(); ++n) {
        before[n] = -0.999 + 0.004 * static_cast<double>(n);
        after[n] = before[n] - 0.05 * (before[n] + 0.8) + 0.004 * scatter(random);
    }
    const ChargeProjection projection = fit(before, after.max(-1), {-1.0});
    ASSERT_TRUE(projection.groups()[0].fromBurst);
    const auto leap = projection.leap(40, 0.9, true);
    EXPECT_GE(leap.charge.minCoeff(), -1);
    EXPECT_GT(leap.stopped, 0);
}

TEST(ChargeProjection, takesEveryParticleToTheEquilibriumOfItsOwnSizeAndNotBeyond)
{
    // Equilibrium charges s = 0.36 and 1.44, the mean's being 1; the larger ones are behind.
    const Scalars share = charges({0.36, 1.44, 0.36, 1.44, 0.36, 1.44});
    const Scalars before = share * charges({0.5, 0.1, 0.45, 0.15, 0.55, 0.05});
    const Scalars after = share * relaxed(before / share, 0.05);
    const ChargeProjection projection(before, after, share, std::vector<int>(6, 0), {{1.0}}, MPI_COMM_SELF);
    EXPECT_NEAR(projection.totalGain(), (after - before).sum(), 1e-14);
    for (const long bursts : {9L, 1000L}) {
        const auto leap = projection.leap(bursts, 0.5, true);
        const Scalars exact = share * relaxed(after / share, 0.05 * static_cast<double>(bursts));
        EXPECT_NEAR((leap.charge / exact - 1).abs().maxCoeff(), 0, 1e-9);
        EXPECT_LE((leap.charge / share).maxCoeff(), 1 + 1e-12);
        EXPECT_NEAR(leap.gained, (leap.charge - after).sum(), 1e-13);
    }
    // Without walls the sum of the charges stays, not that of the charges over the shares.
    EXPECT_NEAR(projection.leap(9, 0.5, false).charge.sum(), after.sum(), 1e-13);
}

TEST(ChargeProjection, holdsWhatNothingIsKnownOf)
{
    const Scalars before = charges({0, 1, 2});
    const Scalars after = charges({1, 3, 5});
    const ChargeProjection away = fit(before, after, {-50});  // the gain leads away from it
    EXPECT_TRUE(away.groups()[0].held);
    EXPECT_EQ((away.leap(100, 0.5, true).charge - after).abs().maxCoeff(), 0);
    const Scalars still = charges({1, 2, 3});
    const ChargeProjection nothing = fit(still, still, {7});
    EXPECT_EQ((nothing.leap(100, 0, true).charge - still).abs().maxCoeff(), 0);
    EXPECT_EQ(nothing.leap(100, 0, true).gained, 0);
}

TEST(ChargeProjection, fitsEveryGroupByItselfOnAnyNumberOfRanks)
{
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    std::vector<double> before, after;
    std::vector<int> group;
    for (int n = rank; n < 40; n += ranks) {
        const double q = 0.01 * n;
        before.push_back(q);
        group.push_back(n % 2);
        after.push_back(n % 2 ? -3 + (q + 3) * std::exp(-0.01) : 1 + (q - 1) * std::exp(-0.02));
    }
    const auto rows = static_cast<Index>(before.size());
    const ChargeProjection projection(Eigen::Map<Scalars>(before.data(), rows), Eigen::Map<Scalars>(after.data(), rows),
                                      Scalars::Ones(rows), group, {{}, {}}, MPI_COMM_WORLD);
    EXPECT_NEAR(projection.groups()[0].limit(), 1, 1e-9);
    EXPECT_NEAR(projection.groups()[1].limit(), -3, 1e-9);
    const auto leap = projection.leap(50, 0, true);
    double mine = (leap.charge - Eigen::Map<Scalars>(after.data(), rows)).sum(), all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_NEAR(leap.gained, all, 1e-12);
}

TEST(ChargeProjection, withoutWallsTheSumStays)
{
    // Two kinds that exchange charge with each other only, the first gains what the second loses.
    const Scalars before = charges({0.0, 0.1, 0.3, -0.1, 0.0, -0.2});
    const Scalars after = charges({0.10, 0.19, 0.34, -0.18, -0.09, -0.26});
    const ChargeProjection projection(before, after, Scalars::Ones(6), {0, 0, 0, 1, 1, 1}, {{}, {}}, MPI_COMM_SELF);
    ASSERT_NEAR(projection.totalGain(), 0, 1e-16);
    ASSERT_TRUE(projection.groups()[0].fromBurst);
    const auto leap = projection.leap(20, 0.3, false);
    EXPECT_GT((leap.charge - after).abs().maxCoeff(), 0.1);
    EXPECT_NEAR(leap.charge.sum(), after.sum(), 1e-15);
    EXPECT_EQ(leap.gained, 0);
}

TEST(ChargeProjection, refusesNonsense)
{
    const Scalars still = charges({1, 2, 3});
    EXPECT_THROW(fit(still, still).leap(-1, 0, true), std::invalid_argument);
    EXPECT_THROW(fit(still, charges({1})), std::invalid_argument);
}

TEST(RestFactor, isARandomWalkWithoutAndTheOwnGainWithFullCorrelation)
{
    EXPECT_NEAR(restFactor(9, 0, 0), std::sqrt(10.0) - 1, 1e-14);
    EXPECT_NEAR(restFactor(9, 1, 0), 9, 1e-13);
    EXPECT_NEAR(restFactor(9, -0.3, 0), std::sqrt(10.0) - 1, 1e-14);
    EXPECT_EQ(restFactor(0, 0.5, -0.1), 0);
    // By its definition.
    const double rho = 0.6, slope = -0.05;
    const int n = 7;
    double sum = 0;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            sum += std::pow(1 + slope, 2 * n - i - j) * std::pow(rho, std::abs(i - j));
        }
    }
    EXPECT_NEAR(restFactor(n, rho, slope), std::sqrt(sum) - std::pow(1 + slope, n), 1e-13);
}

TEST(ChargeProjection, errorIsTheShareByWhichTheGainWasMisjudged)
{
    EXPECT_EQ(projectionError(2, 2), 0);
    EXPECT_NEAR(projectionError(2, 1), 0.5, 1e-15);
    EXPECT_NEAR(projectionError(-1, 1), 2, 1e-15);
    EXPECT_EQ(projectionError(0, 0), 0);
}

/// In every step each particle has some chance to touch the wall and then gains x (1 - q). Particles near the wall, a tenth of them,
/// touch it ten times as often; in every step a particle changes its place with a chance that makes the bed mixed or not.
struct Moments {
    double mean, spread;
};

Moments momentsOf(const Scalars& charge)
{
    const double mean = charge.mean();
    return {mean, std::sqrt((charge - mean).square().mean())};
}

class Bed {
public:
    Bed(unsigned seed, double mixing) : random_(seed), mixing_(mixing), charge(Scalars::Zero(2000))
    {
        for (Index n = 0; n < charge.size(); ++n) {
            near_.push_back(chance_(random_) < 0.1);
        }
    }

    void steps(int number, double x)
    {
        for (int k = 0; k < number; ++k) {
            for (Index n = 0; n < charge.size(); ++n) {
                char& near = near_[static_cast<std::size_t>(n)];
                if (chance_(random_) < mixing_) {
                    near = chance_(random_) < 0.1;
                }
                if (chance_(random_) < (near ? 0.1 : 0.01)) {
                    charge[n] += -std::expm1(-x) * (1 - charge[n]);
                }
            }
        }
    }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<double> chance_{0, 1};
    double mixing_;
    std::vector<char> near_;

public:
    Scalars charge;
};

/// Mean and spread after 4000 steps, by bursts of 100 and leaps of 9 bursts.
Moments projected(double mixing, double x)
{
    Bed bed(1, mixing);
    Scalars restBefore;
    double together = 0, squares = 0;
    for (int n = 0; n < 4000; n += 1000) {
        const Scalars before = bed.charge;
        bed.steps(100, x);
        const ChargeProjection projection = fit(before, bed.charge, {1.0});
        if (restBefore.size() > 0) {
            together += (restBefore * projection.rest()).sum();
            squares += 0.5 * (restBefore.square() + projection.rest().square()).sum();
        }
        restBefore = projection.rest();
        bed.charge = projection.leap(9, squares > 0 ? together / squares : 0, true).charge;
    }
    return momentsOf(bed.charge);
}

TEST(ChargeProjection, keepsMeanAndSpreadOfABedWhereAccelerationWidensIt)
{
    constexpr double x = 0.01;
    for (const double mixing : {1.0, 0.01}) {
        Bed plain(1, mixing), accelerated(1, mixing);
        plain.steps(4000, x);
        accelerated.steps(400, 10 * x);
        const Moments exact = momentsOf(plain.charge), fast = momentsOf(accelerated.charge),
                      ours = projected(mixing, x);
        std::printf("mixing %g, mean and spread: plain %.4f %.4f, accelerated %.4f %.4f, projected %.4f %.4f\n", mixing,
                    exact.mean, exact.spread, fast.mean, fast.spread, ours.mean, ours.spread);
        EXPECT_NEAR(ours.mean / exact.mean, 1, 0.05);
        EXPECT_NEAR(ours.spread / exact.spread, 1, 0.15);
        EXPECT_GT(fast.spread, 2 * exact.spread);
    }
}

}  // namespace
}  // namespace him
