// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/particle_statistics.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace him {

RegionStatistics::RegionStatistics(StatisticsRegion region, std::size_t wallForces, MPI_Comm communicator)
    : region_(std::move(region)), wallForces_(wallForces), communicator_(communicator)
{
    beginAverages();
}

void RegionStatistics::beginAverages()
{
    samples_ = 0;
    total_ = RegionSample();
    total_.sums.layers.assign(static_cast<std::size_t>(region_.layers), 0.0);
    total_.carriedByWall.assign(wallForces_, 0.0);
    histogram_.clear();
    if (region_.chargeBins > 0) {
        histogram_.emplace_back(region_.lowestCharge, region_.highestCharge, region_.chargeBins);
    }
    profile_.clear();
    if (region_.profileBins > 0) {
        profile_.emplace_back(region_.place, region_.profileWidth, region_.profileBins);
    }
}

RegionSample RegionStatistics::sample(const DemParticles& particles, const Points& field,
                                      const std::vector<Points>& wallForces, const Vector3& gravity) const
{
    for (const Points& ofWall : wallForces) {
        if (ofWall.rows() != particles.size()) {
            throw std::logic_error("statistics: the wall forces are not those of the particles last read");
        }
    }
    RegionSample sample;
    // Without walls every particle is infinitely far from one, so the one layer asked for stays empty.
    const double thickness = region_.layers > 0 ? region_.layerThickness : 1;
    sample.sums = sumOver(particles, field, region_.place, thickness, std::max(1, region_.layers));
    sample.sums.layers.resize(static_cast<std::size_t>(region_.layers));
    sumOverRanks(sample.sums, communicator_);

    const double strength = gravity.norm();
    sample.weight = sample.sums.mass * strength;
    sample.carriedByWall.assign(wallForces_, 0.0);
    if (strength > 0 && !sample.carriedByWall.empty()) {
        const Vector3 up = -gravity / strength;
        for (Index row = 0; row < particles.size(); ++row) {
            if (!region_.place.box.contains(particles.position.row(row).matrix().transpose())) {
                continue;
            }
            for (std::size_t wall = 0; wall < wallForces.size(); ++wall) {
                sample.carriedByWall[wall] += wallForces[wall].row(row).matrix().dot(up.transpose());
            }
        }
        MPI_Allreduce(MPI_IN_PLACE, sample.carriedByWall.data(), static_cast<int>(wallForces_), MPI_DOUBLE, MPI_SUM,
                      communicator_);
    }
    return sample;
}

void RegionStatistics::average(const DemParticles& particles, const Points& field, const RegionSample& sample)
{
    samples_ += 1;
    for (ChargeHistogram& histogram : histogram_) {
        histogram.add(particles, region_.place);
    }
    for (WallProfile& profile : profile_) {
        profile.add(particles, field);
    }
    RegionSums& sums = total_.sums;
    sums.particles += sample.sums.particles;
    sums.mass += sample.sums.mass;
    sums.charge += sample.sums.charge;
    sums.wallParticles += sample.sums.wallParticles;
    sums.wallSquaredSpeed += sample.sums.wallSquaredSpeed;
    sums.forceOnWall += sample.sums.forceOnWall;
    total_.weight += sample.weight;
    for (std::size_t n = 0; n < sums.layers.size(); ++n) {
        sums.layers[n] += sample.sums.layers[n];
    }
    for (std::size_t n = 0; n < wallForces_; ++n) {
        total_.carriedByWall[n] += sample.carriedByWall[n];
    }
}

RegionSample RegionStatistics::averages() const
{
    RegionSample mean = total_;
    const double share = samples_ > 0 ? 1 / samples_ : 0;
    RegionSums& sums = mean.sums;
    for (double* value : {&sums.particles, &sums.mass, &sums.charge, &sums.wallParticles, &sums.wallSquaredSpeed,
                          &sums.forceOnWall, &mean.weight}) {
        *value *= share;
    }
    for (std::vector<double>* values : {&sums.layers, &mean.carriedByWall}) {
        for (double& value : *values) {
            value *= share;
        }
    }
    return mean;
}

std::vector<double> RegionStatistics::chargeCounts() const
{
    return histogram_.empty() ? std::vector<double>() : histogram_.front().counts(communicator_);
}

std::vector<WallProfile::Row> RegionStatistics::profile() const
{
    return profile_.empty() ? std::vector<WallProfile::Row>() : profile_.front().rows(communicator_);
}

ParticleScale scaleOf(const DemParticles& particles, MPI_Comm communicator)
{
    std::array<double, 2> sums{static_cast<double>(particles.size()), 2 * particles.radius.sum()};
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, communicator);
    double largest = particles.size() > 0 ? particles.charge.abs().maxCoeff() : 0;
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
    return {sums[0], sums[0] > 0 ? sums[1] / sums[0] : 0, largest};
}

}  // namespace him
