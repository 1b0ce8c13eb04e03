// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/exchange/mesh_halo.hpp"
#include "dem_coupling/exchange/mesh_locator.hpp"
#include "electrostatics/p3m/cloud_sources.hpp"

namespace him {

/// Moves charges from the ranks that own the particles to the ranks whose cells hold them, with copies for the ranks and
/// periods around, and brings results back.
class ParticlesOnMesh {
public:
    /// Fills `sources` with the charges in this rank's cells, sorted by cell, as targets, then with copies of all charges of
    /// other ranks and periods within `reach` [m] of the box around this rank's cell centres. Collective.
    /// @param locator  after locate() of these positions; rows outside the mesh are left out
    void distribute(const MeshLocator& locator, const DemParticles& particles, MeshHalo& halo, double reach,
                    CloudSources& sources);
    /// Tags of the targets.
    const std::vector<int>& tags() const { return tags_; }

    /// Values of the targets, one row each, to the rows of the positions; zero for rows outside the mesh. Only neighbours
    /// talk.
    void bringBack(const Eigen::ArrayXXd& atTargets, Eigen::ArrayXXd& atRows, SparseExchange& exchange);

private:
    void addCopies(MeshHalo& halo, double reach, CloudSources& sources);

    std::vector<int> tags_;
    std::vector<std::vector<Index>> sentRows_;  ///< rows that each rank got
    std::vector<std::vector<Index>> targetOf_;  ///< target that what each rank sent became
    std::vector<Index> nextOfCell_;             ///< where the next target of each cell goes
    SparseExchange::Buffers outgoing_, incoming_;
};

}  // namespace him
