// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/particle_statistics.hpp"
#include "dem_coupling/statistics/saturation_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace him {
namespace {

/// A column of 4 x 4 x 10 mm whose four sides are walls.
WalledBox column()
{
    WalledBox region;
    region.box.lower = Vector3(-2e-3, -2e-3, 0);
    region.box.upper = Vector3(2e-3, 2e-3, 10e-3);
    region.walls = {true, true, true, true, false, false};
    return region;
}

struct Given {
    Vector3 place, velocity, field;
    double charge;
};

/// The particles that fall to this rank, each of 2 mg.
void dealOut(const std::vector<Given>& given, DemParticles& particles, Points& field)
{
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    std::vector<Given> mine;
    for (std::size_t n = 0; n < given.size(); ++n) {
        if (static_cast<int>(n) % ranks == rank) {
            mine.push_back(given[n]);
        }
    }
    const auto rows = static_cast<Index>(mine.size());
    particles.tag.assign(mine.size(), 1);
    particles.type.assign(mine.size(), 1);
    particles.position.resize(rows, 3);
    particles.velocity.resize(rows, 3);
    particles.charge.resize(rows);
    particles.radius = Scalars::Constant(rows, 1e-4);
    particles.mass = Scalars::Constant(rows, 2e-6);
    field.resize(rows, 3);
    for (Index row = 0; row < rows; ++row) {
        const Given& one = mine[static_cast<std::size_t>(row)];
        particles.position.row(row) = one.place.transpose().array();
        particles.velocity.row(row) = one.velocity.transpose().array();
        field.row(row) = one.field.transpose().array();
        particles.charge[row] = one.charge;
    }
}

/// Layers of 0.5 mm: two particles in the first, one in the second, one in the middle, one outside the region.
const std::vector<Given> five{
    {Vector3(1.9e-3, 0, 1e-3), Vector3(3, 0, 4), Vector3(1e5, 7e4, 0), 2e-12},
    {Vector3(0, -1.7e-3, 2e-3), Vector3(0, 0, 1), Vector3(0, -2e5, 0), 1e-12},
    {Vector3(-1.2e-3, 0, 3e-3), Vector3(9, 9, 9), Vector3(-1e5, 0, 0), -4e-12},
    {Vector3(0, 0, 4e-3), Vector3(9, 9, 9), Vector3(0, 0, 1e5), 3e-12},
    {Vector3(0, 0, 11e-3), Vector3(9, 9, 9), Vector3(0, 0, 1e5), 77e-12},
};

TEST(WalledBox, tellsDistanceAndDirectionOfTheNearestWall)
{
    const WalledBox::Nearest wall = column().nearest(Vector3(0.5e-3, -1.25e-3, 9e-3));
    EXPECT_NEAR(wall.distance, 0.75e-3, 1e-18);
    EXPECT_EQ(wall.toWall, Vector3(0, -1, 0));
}

TEST(WalledBox, hasTheVolumeOfAFrame)
{
    const WalledBox region = column();
    EXPECT_NEAR(region.volumeWithin(0.5e-3) / (10e-3 * (16e-6 - 9e-6)), 1, 1e-12);
    EXPECT_NEAR(region.volumeWithin(2e-3) / 160e-9, 1, 1e-12);
    EXPECT_NEAR(region.volumeWithin(1) / 160e-9, 1, 1e-12);
}

TEST(ParticleStatistics, sumsWhatIsInTheRegionAndInItsLayers)
{
    DemParticles particles;
    Points field;
    dealOut(five, particles, field);
    RegionSums sums = sumOver(particles, field, column(), 0.5e-3, 3);
    sumOverRanks(sums, MPI_COMM_WORLD);
    EXPECT_EQ(sums.particles, 4);
    EXPECT_NEAR(sums.mass, 8e-6, 1e-20);
    EXPECT_NEAR(sums.charge, 2e-12, 1e-26);
    EXPECT_NEAR(sums.chargePerMass(), 2.5e-7, 1e-20);
    EXPECT_NEAR(sums.meanCharge(), 0.5e-12, 1e-26);
    EXPECT_EQ(sums.layers, (std::vector<double>{2, 1, 0}));
    EXPECT_EQ(sums.wallParticles, 2);
    EXPECT_NEAR(sums.wallSpeed(), std::sqrt(13.0), 1e-14);  // (25 + 1)/2
    EXPECT_NEAR(sums.forceOnWall, 2e-7 + 2e-7, 1e-21);      // only the part along the wall's normal
}

TEST(ParticleStatistics, anEmptyRegionHasNoMeans)
{
    DemParticles particles;
    Points field;
    dealOut({}, particles, field);
    RegionSums sums = sumOver(particles, field, column(), 1e-3, 2);
    sumOverRanks(sums, MPI_COMM_WORLD);
    EXPECT_EQ(sums.chargePerMass(), 0);
    EXPECT_EQ(sums.wallSpeed(), 0);
}

TEST(ParticleStatistics, theProfileAveragesOverSamples)
{
    DemParticles particles;
    Points field;
    dealOut(five, particles, field);
    const WalledBox region = column();
    WallProfile profile(region, 0.5e-3, 4);
    profile.add(particles, field);
    profile.add(particles, field);
    const auto rows = profile.rows(MPI_COMM_WORLD);
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_NEAR(rows[0].distance, 0.25e-3, 1e-18);
    EXPECT_NEAR(rows[0].numberDensity / (2 / 70e-9), 1, 1e-12);
    EXPECT_NEAR(rows[1].numberDensity / (1 / 50e-9), 1, 1e-12);
    EXPECT_EQ(rows[2].numberDensity, 0);
    EXPECT_NEAR(rows[0].meanCharge, 1.5e-12, 1e-26);
    EXPECT_NEAR(rows[0].meanForce, 2e-7, 1e-21);
    EXPECT_NEAR(rows[1].meanForce, -4e-7, 1e-21);
    EXPECT_EQ(rows[2].meanCharge, 0);
    // Everything is somewhere: the densities times the volumes add up to the particles of the frame.
    double all = 0;
    for (std::size_t n = 0; n < rows.size(); ++n) {
        all += rows[n].numberDensity
               * (region.volumeWithin(0.5e-3 * static_cast<double>(n + 1))
                  - region.volumeWithin(0.5e-3 * static_cast<double>(n)));
    }
    EXPECT_NEAR(all, 3, 1e-12);  // the one in the middle, at 2 mm, is just beyond the last bin
}

TEST(ParticleStatistics, theHistogramIsADensityOfAllParticles)
{
    DemParticles particles;
    Points field;
    dealOut(five, particles, field);
    ChargeHistogram histogram(-2e-12, 4e-12, 3);
    histogram.add(particles, column());
    const auto counts = histogram.counts(MPI_COMM_WORLD);
    EXPECT_EQ(counts, (std::vector<double>{0, 1, 2, 1, 0}));
    const auto density = histogram.density(counts);
    EXPECT_NEAR(density[1] / (1 / (4 * 2e-12)), 1, 1e-12);
    EXPECT_NEAR(density[2] / (2 / (4 * 2e-12)), 1, 1e-12);
    EXPECT_NEAR(histogram.centre(2), 3e-12, 1e-26);
}

TEST(ParticleStatistics, refuseSettingsThatMeanNothing)
{
    EXPECT_THROW(ChargeHistogram(1, 1, 3), std::invalid_argument);
    EXPECT_THROW(ChargeHistogram(0, 1, 0), std::invalid_argument);
    EXPECT_THROW(WallProfile(column(), 0, 3), std::invalid_argument);
    EXPECT_THROW(WallProfile(WalledBox(), 1e-3, 3), std::invalid_argument);
    EXPECT_THROW(sumOver({}, Points(0, 3), column(), 0, 3), std::invalid_argument);
}

TEST(SaturationCurve, isFoundFromItsOwnValues)
{
    for (const double timeScale : {7.5, 0.75}) {
        std::vector<double> times, values;
        for (int n = 1; n <= 40; ++n) {
            times.push_back(0.1 * n);
            values.push_back(-3e-5 * -std::expm1(-0.1 * n / timeScale));
        }
        const SaturationCurve curve = fitSaturationCurve(times, values);
        ASSERT_TRUE(curve.known);
        EXPECT_NEAR(curve.limit / -3e-5, 1, 1e-6);
        EXPECT_NEAR(curve.timeScale / timeScale, 1, 1e-6);
        EXPECT_LT(curve.deviation, 1e-11);
    }
}

TEST(RunningSaturation, keepsToFewValuesAndFindsTheCurveOfALongRun)
{
    RunningSaturation running;
    running.add(0, 0);  // the start tells nothing
    EXPECT_EQ(running.values(), 0U);
    for (int n = 1; n <= 100000; ++n) {
        running.add(1e-4 * n, 4e-5 * -std::expm1(-1e-4 * n / 2.5));
        ASSERT_LT(running.values(), RunningSaturation::mostValues);
    }
    ASSERT_TRUE(running.curve().known);
    EXPECT_NEAR(running.curve().limit / 4e-5, 1, 1e-6);
    EXPECT_NEAR(running.curve().timeScale / 2.5, 1, 1e-6);
}

TEST(RegionStatistics, averagesSamplesAndWeighsWhatWallsCarry)
{
    DemParticles particles;
    Points field;
    dealOut(five, particles, field);
    StatisticsRegion settings;
    settings.place = column();
    settings.layerThickness = 0.5e-3;
    settings.layers = 2;
    settings.profileWidth = 0.5e-3;
    settings.profileBins = 4;
    settings.lowestCharge = -5e-12;
    settings.highestCharge = 5e-12;
    settings.chargeBins = 10;
    RegionStatistics statistics(settings, 2, MPI_COMM_WORLD);
    const Vector3 gravity(0, -10, 0);
    // One wall holds every particle with 3 uN, also the one outside the region; the other pulls with 1 uN.
    Points held = Points::Zero(particles.size(), 3), pulled = held;
    held.col(1) = 3e-6;
    pulled.col(1) = -1e-6;
    pulled.col(0) = 7e-6;
    const RegionSample first = statistics.sample(particles, field, {held, pulled}, gravity);
    EXPECT_NEAR(first.weight, 8e-5, 1e-18);
    EXPECT_NEAR(first.carriedByWall[0], 12e-6, 1e-18);
    EXPECT_NEAR(first.carriedByWall[1], -4e-6, 1e-18);
    statistics.average(particles, field, first);
    particles.charge *= 3;
    statistics.average(particles, field, statistics.sample(particles, field, {}, gravity));
    EXPECT_EQ(statistics.samples(), 2);
    const RegionSample mean = statistics.averages();
    EXPECT_NEAR(mean.sums.charge, 4e-12, 1e-26);
    EXPECT_EQ(mean.sums.layers, (std::vector<double>{2, 1}));
    EXPECT_NEAR(mean.carriedByWall[0], 6e-6, 1e-18);
    EXPECT_NEAR(mean.sums.wallSpeed(), std::sqrt(13.0), 1e-14);
    EXPECT_NEAR(statistics.profile()[0].meanCharge, 3e-12, 1e-26);
    EXPECT_EQ(statistics.chargeCounts().back(), 2);  // 6 and 9 pC lie above the range
    statistics.beginAverages();
    EXPECT_EQ(statistics.samples(), 0);
    EXPECT_EQ(statistics.averages().sums.charge, 0);
    EXPECT_EQ(statistics.profile()[0].numberDensity, 0);
}

TEST(RegionStatistics, aRegionWithoutWallsHasNoLayersAndNoProfile)
{
    DemParticles particles;
    Points field;
    dealOut(five, particles, field);
    StatisticsRegion settings;
    settings.place.box = column().box;
    settings.lowestCharge = -1;
    settings.highestCharge = 1;
    settings.chargeBins = 1;
    RegionStatistics statistics(settings, 0, MPI_COMM_WORLD);
    const RegionSample sample = statistics.sample(particles, field, {}, Vector3::Zero());
    EXPECT_EQ(sample.sums.particles, 4);
    EXPECT_EQ(sample.weight, 0);
    EXPECT_TRUE(sample.sums.layers.empty());
    EXPECT_TRUE(statistics.profile().empty());
}

TEST(SaturationCurve, isUnknownWhereNothingBends)
{
    EXPECT_FALSE(fitSaturationCurve({1, 2}, {1, 1.5}).known);
    EXPECT_FALSE(fitSaturationCurve({1, 2, 3}, {0, 0, 0}).known);
    EXPECT_FALSE(fitSaturationCurve({1, 2, 3, 4}, {1, 2, 3, 4}).known);
    EXPECT_THROW(fitSaturationCurve({0, 1, 2}, {0, 1, 2}), std::invalid_argument);
    EXPECT_THROW(fitSaturationCurve({1, 2, 3}, {0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace him
