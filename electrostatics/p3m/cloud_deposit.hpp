// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/cloud_sources.hpp"

namespace him {

/// Samples the clouds g = c (1 - (r/R)^2)^k of charges and their images at the cell centres. The weights
/// w_c = V_c g(|x_c - x_j|) of a charge and its own images are divided by their sum T_j, so that its charge on the mesh is
/// exact however few cells the cloud sees; where a wall in reach has no image, only the part of the cloud inside the mesh
/// counts and c alone scales it. Near curved walls, where tangent planes mirror, the weights are multiplied by
/// a + b.(x_c - x_j)/R as well, so that neither charge nor dipole moment of the cloud with its images changes by sampling
/// (image offsets mirrored back).
class CloudDeposit {
public:
    /// @param mesh, table  outlive this
    /// @param radius       R [m]
    /// @param exponent     k, 1 or 2
    CloudDeposit(const LocalMesh& mesh, SurroundingsTable& table, double radius, int exponent);

    /// Charge [C] of the own cells from all sources.
    void deposit(const CloudSources& sources, Scalars& cellCharge);
    /// Charge [C] that one row with its images gives to each of the cells around its own, in the order of Surroundings::cells.
    void depositOne(const CloudSources& sources, Index row, Scalars& charge);

private:
    bool reachesOwn(const CloudSources& sources, Index row, const Surroundings& around) const;
    void loadCells(const Surroundings& around);
    void add(const CloudSources& sources, Index row, const Surroundings& around);
    void addCloud(const CloudSources& sources, Index row, bool normalise);
    void addCloudWithoutMoment(const CloudSources& sources, Index row, Index cells);

    const LocalMesh& mesh_;
    SurroundingsTable& table_;
    double radius_;
    int exponent_;
    double amplitude_;                            ///< c [1/m3]
    Scalars cellX_, cellY_, cellZ_, cellVolume_;  ///< of all cells of the local mesh, padded
    Index loaded_ = 0;                            ///< cells around the present host, in whole blocks
    Scalars x_, y_, z_, volume_;                  ///< of these cells, one after the other
    struct Sample {
        Index cell;     ///< among the cells around the host
        double weight;  ///< [m3]
        double sign;
        Vector3 offset;  ///< from the source, over R, mirrored back for an image
    };
    std::vector<Sample> samples_;
    Scalars cloud_, charge_;  ///< at these cells: weights of one charge, charge of all in the host
};

}  // namespace him
