// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/statistics/walled_box.hpp"

#include <cstdint>
#include <vector>

namespace him {

/// Numbers of one moment in one region, summed over ranks.
struct RegionSums {
    double particles = 0;
    double mass = 0;              ///< [kg]
    double charge = 0;            ///< [C]
    double wallParticles = 0;     ///< in the first layer
    double wallSquaredSpeed = 0;  ///< sum over these of v^2 [m2/s2]
    double forceOnWall = 0;       ///< sum over these of the electrostatic force towards the wall [N]
    std::vector<double> layers;   ///< particles by layer number, the first at the wall

    double chargePerMass() const { return mass > 0 ? charge / mass : 0; }
    double meanCharge() const { return particles > 0 ? charge / particles : 0; }
    /// Root mean square speed of the first layer [m/s]; 0 when it is empty.
    double wallSpeed() const;
};

/// Sums over this rank's particles whose centres lie in the region; layer n holds centres between (n-1) d and n d from the
/// nearest wall.
/// @param field           of the particles [V/m]
/// @param layerThickness  d [m], the mean diameter
/// @param layers          how many layers are told apart
RegionSums sumOver(const DemParticles& particles, const Points& field, const WalledBox& region, double layerThickness,
                   int layers);
/// Adds up the sums of all ranks. Collective.
void sumOverRanks(RegionSums& sums, MPI_Comm communicator);

/// Probability density of the particles' charge over equal bins, averaged over samples.
class ChargeHistogram {
public:
    /// Throws std::invalid_argument unless lower < upper and bins > 0.
    /// @param lower, upper  range [C]
    ChargeHistogram(double lower, double upper, int bins);

    void add(const DemParticles& particles, const WalledBox& region);
    /// Counts of all ranks. Collective.
    std::vector<double> counts(MPI_Comm communicator) const;
    /// Density [1/C] of each bin: count/(all counts, also those out of range, times width).
    std::vector<double> density(const std::vector<double>& counts) const;
    double centre(int bin) const { return lower_ + (bin + 0.5) * width_; }
    int bins() const { return static_cast<int>(counts_.size()) - 2; }

private:
    double lower_, width_;
    std::vector<double> counts_;  ///< bins, then below the range and above it
};

/// Profiles against the distance from the nearest wall, averaged over samples: number density, mean charge, mean
/// electrostatic force towards the wall.
class WallProfile {
public:
    /// Throws std::invalid_argument unless width > 0, bins > 0 and the region has a wall.
    WallProfile(const WalledBox& region, double width, int bins);

    void add(const DemParticles& particles, const Points& field);

    struct Row {
        double distance;       ///< of the middle of the bin [m]
        double numberDensity;  ///< [1/m3]
        double meanCharge;     ///< [C]; 0 in an empty bin
        double meanForce;      ///< towards the wall [N]; 0 in an empty bin
    };
    /// Averages over all samples and ranks. Collective.
    std::vector<Row> rows(MPI_Comm communicator) const;

private:
    WalledBox region_;
    double width_;
    double samples_ = 0;
    std::vector<double> count_, charge_, force_;
};

}  // namespace him
