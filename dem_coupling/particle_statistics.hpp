// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/statistics/particle_sums.hpp"
#include "dem_coupling/statistics/running_saturation.hpp"

#include <string>
#include <vector>

namespace him {

/// A region of the scene and what is measured in it.
struct StatisticsRegion {
    std::string name;
    WalledBox place;
    double layerThickness = 0;   ///< [m]
    int layers = 0;              ///< told apart in the series; 0 where no side is a wall
    double profileWidth = 0;     ///< of a bin [m]
    int profileBins = 0;         ///< 0: no profile
    double lowestCharge = 0;     ///< range of the charge distribution [C]
    double highestCharge = 0;
    int chargeBins = 0;          ///< 0: no distribution
};

/// Numbers of one region at one moment.
struct RegionSample {
    RegionSums sums;
    double weight = 0;                 ///< of the particles of the region [N]; 0 without gravity
    std::vector<double> carriedByWall; ///< force against gravity of each wall's contacts on these [N], see WallForces::names
};

/// Statistics of one region: a sample at a time, and averages over samples until they are begun anew.
class RegionStatistics {
public:
    /// Throws std::invalid_argument for settings that mean nothing, see ChargeHistogram and WallProfile.
    /// @param wallForces  how many walls' contact forces the samples will hold
    RegionStatistics(StatisticsRegion region, std::size_t wallForces, MPI_Comm communicator);

    const StatisticsRegion& region() const { return region_; }

    /// Sums over all ranks. Collective.
    /// @param field       of the particles [V/m]
    /// @param wallForces  of the same particles, in the order of DemPort::keepWallForces(); may hold fewer: those count as 0
    /// @param gravity     [m/s2]
    RegionSample sample(const DemParticles& particles, const Points& field, const std::vector<Points>& wallForces,
                        const Vector3& gravity) const;
    /// Adds the same particles to distribution and profile, and the sample to the averages.
    void average(const DemParticles& particles, const Points& field, const RegionSample& sample);

    double samples() const { return samples_; }
    /// Averages over the samples since the last beginAverages(); wallSpeed() of them is the RMS over samples and particles.
    RegionSample averages() const;
    std::vector<WallProfile::Row> profile() const;  ///< empty without a profile. Collective
    /// Counts of the charge bins, then below and above the range; empty without a distribution. Collective.
    std::vector<double> chargeCounts() const;
    const ChargeHistogram& histogram() const { return histogram_.front(); }
    void beginAverages();

private:
    StatisticsRegion region_;
    std::size_t wallForces_;
    MPI_Comm communicator_;
    double samples_ = 0;
    RegionSample total_;
    std::vector<ChargeHistogram> histogram_;  ///< one or none
    std::vector<WallProfile> profile_;        ///< one or none
};

/// Means over the particles of all ranks, for settings that a case leaves open. Collective.
struct ParticleScale {
    double particles = 0;
    double meanDiameter = 0;   ///< [m]; 0 without particles
    double largestCharge = 0;  ///< absolute [C]
};
ParticleScale scaleOf(const DemParticles& particles, MPI_Comm communicator);

}  // namespace him
