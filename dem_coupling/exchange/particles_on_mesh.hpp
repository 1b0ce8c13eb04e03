// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/exchange/mesh_halo.hpp"
#include "dem_coupling/exchange/mesh_locator.hpp"
#include "electrostatics/p3m/cloud_sources.hpp"

#include <cstdint>
#include <vector>

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

    /// Values of the targets, one row each, to the rows of the positions. Only neighbours talk.
    /// @param take  called once for every row of the positions with its number and its values (const double*); zeros outside the mesh
    template <class Take> void bringBack(const Eigen::ArrayXXd& atTargets, SparseExchange& exchange, const Take& take);

private:
    void addCopies(MeshHalo& halo, double reach, CloudSources& sources);

    std::vector<int> tags_;
    /// What a row became: a target of this rank, or none of its own.
    std::vector<std::int32_t> targetOfRow_;
    static constexpr std::int32_t elsewhere = -1, outside = -2;
    std::vector<std::vector<Index>> sentRows_;  ///< rows that each other rank got
    std::vector<std::vector<Index>> targetOf_;  ///< target that what each other rank sent became
    std::vector<Index> nextOfCell_;             ///< where the next target of each cell goes
    SparseExchange::Buffers outgoing_, incoming_;
    std::vector<double> values_;  ///< of one row
};

template <class Take>
void ParticlesOnMesh::bringBack(const Eigen::ArrayXXd& atTargets, SparseExchange& exchange, const Take& take)
{
    const auto columns = static_cast<std::size_t>(atTargets.cols());
    exchange.clear(outgoing_);
    exchange.clear(incoming_);
    for (std::size_t rank = 0; rank < targetOf_.size(); ++rank) {
        for (const Index target : targetOf_[rank]) {
            for (Index k = 0; k < atTargets.cols(); ++k) {
                outgoing_[rank].push_back(atTargets(target, k));
            }
        }
        incoming_[rank].resize(columns * sentRows_[rank].size());
    }
    exchange.answer(outgoing_, incoming_);
    values_.resize(columns);
    for (std::size_t row = 0; row < targetOfRow_.size(); ++row) {
        const std::int32_t target = targetOfRow_[row];
        if (target == elsewhere) {
            continue;
        }
        for (std::size_t k = 0; k < columns; ++k) {
            values_[k] = target == outside ? 0 : atTargets(target, static_cast<Index>(k));
        }
        take(static_cast<Index>(row), static_cast<const double*>(values_.data()));
    }
    for (std::size_t rank = 0; rank < sentRows_.size(); ++rank) {
        for (std::size_t n = 0; n < sentRows_[rank].size(); ++n) {
            take(sentRows_[rank][n], static_cast<const double*>(incoming_[rank].data() + n * columns));
        }
    }
}

}  // namespace him
