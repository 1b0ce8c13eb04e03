// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/statistics/particle_sums.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace him {

double RegionSums::wallSpeed() const
{
    return wallParticles > 0 ? std::sqrt(wallSquaredSpeed / wallParticles) : 0;
}

RegionSums sumOver(const DemParticles& particles, const Points& field, const WalledBox& region, double layerThickness,
                   int layers)
{
    if (!(layerThickness > 0) || layers < 1) {
        throw std::invalid_argument("wall layers need a positive thickness and a number of at least 1");
    }
    RegionSums sums;
    sums.layers.assign(static_cast<std::size_t>(layers), 0.0);
    for (Index row = 0; row < particles.size(); ++row) {
        const Vector3 place = particles.position.row(row).matrix().transpose();
        if (!region.box.contains(place)) {
            continue;
        }
        const double mass = particles.mass[row];
        const double charge = particles.charge[row];
        sums.particles += 1;
        sums.mass += mass;
        sums.charge += charge;
        const WalledBox::Nearest wall = region.nearest(place);
        const double layer = std::floor(wall.distance / layerThickness);
        if (layer < layers) {
            sums.layers[static_cast<std::size_t>(layer)] += 1;
        }
        if (layer < 1) {
            sums.wallParticles += 1;
            sums.wallSquaredSpeed += particles.velocity.row(row).square().sum();
            sums.forceOnWall += charge * field.row(row).matrix().dot(wall.toWall.transpose());
        }
    }
    return sums;
}

void sumOverRanks(RegionSums& sums, MPI_Comm communicator)
{
    std::vector<double> all{sums.particles,        sums.mass,       sums.charge, sums.wallParticles,
                            sums.wallSquaredSpeed, sums.forceOnWall};
    all.insert(all.end(), sums.layers.begin(), sums.layers.end());
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, communicator);
    sums.particles = all[0];
    sums.mass = all[1];
    sums.charge = all[2];
    sums.wallParticles = all[3];
    sums.wallSquaredSpeed = all[4];
    sums.forceOnWall = all[5];
    std::copy(all.begin() + 6, all.end(), sums.layers.begin());
}

ChargeHistogram::ChargeHistogram(double lower, double upper, int bins) : lower_(lower), width_((upper - lower) / bins)
{
    if (bins < 1 || !(upper > lower)) {
        throw std::invalid_argument("a histogram needs at least one bin and a range from a lower to a higher charge");
    }
    counts_.assign(static_cast<std::size_t>(bins) + 2, 0.0);
}

void ChargeHistogram::add(const DemParticles& particles, const WalledBox& region)
{
    for (Index row = 0; row < particles.size(); ++row) {
        if (!region.box.contains(particles.position.row(row).matrix().transpose())) {
            continue;
        }
        const double bin = std::floor((particles.charge[row] - lower_) / width_);
        const auto last = static_cast<std::size_t>(bins());
        counts_[bin < 0 ? last : bin >= static_cast<double>(last) ? last + 1 : static_cast<std::size_t>(bin)] += 1;
    }
}

std::vector<double> ChargeHistogram::counts(MPI_Comm communicator) const
{
    std::vector<double> all(counts_);
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, communicator);
    return all;
}

std::vector<double> ChargeHistogram::density(const std::vector<double>& counts) const
{
    double all = 0;
    for (const double count : counts) {
        all += count;
    }
    std::vector<double> density(static_cast<std::size_t>(bins()), 0.0);
    for (std::size_t bin = 0; all > 0 && bin < density.size(); ++bin) {
        density[bin] = counts[bin] / (all * width_);
    }
    return density;
}

WallProfile::WallProfile(const WalledBox& region, double width, int bins) : region_(region), width_(width)
{
    if (!(width > 0) || bins < 1) {
        throw std::invalid_argument("a wall profile needs bins of positive width and at least one of them");
    }
    if (std::none_of(region.walls.begin(), region.walls.end(), [](bool wall) { return wall; })) {
        throw std::invalid_argument("a wall profile needs a region with a wall");
    }
    for (std::vector<double>* values : {&count_, &charge_, &force_}) {
        values->assign(static_cast<std::size_t>(bins), 0.0);
    }
}

void WallProfile::add(const DemParticles& particles, const Points& field)
{
    samples_ += 1;
    for (Index row = 0; row < particles.size(); ++row) {
        const Vector3 place = particles.position.row(row).matrix().transpose();
        if (!region_.box.contains(place)) {
            continue;
        }
        const WalledBox::Nearest wall = region_.nearest(place);
        const double bin = std::floor(wall.distance / width_);
        if (bin < static_cast<double>(count_.size())) {
            const auto b = static_cast<std::size_t>(bin);
            count_[b] += 1;
            charge_[b] += particles.charge[row];
            force_[b] += particles.charge[row] * field.row(row).matrix().dot(wall.toWall.transpose());
        }
    }
}

std::vector<WallProfile::Row> WallProfile::rows(MPI_Comm communicator) const
{
    std::vector<double> all(count_);
    all.insert(all.end(), charge_.begin(), charge_.end());
    all.insert(all.end(), force_.begin(), force_.end());
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, communicator);
    const std::size_t bins = count_.size();
    std::vector<Row> rows;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const double count = all[bin];
        const double low = static_cast<double>(bin) * width_;
        const double volume = region_.volumeWithin(low + width_) - region_.volumeWithin(low);
        rows.push_back({low + 0.5 * width_, samples_ > 0 && volume > 0 ? count / (samples_ * volume) : 0,
                        count > 0 ? all[bins + bin] / count : 0, count > 0 ? all[2 * bins + bin] / count : 0});
    }
    return rows;
}

}  // namespace him
