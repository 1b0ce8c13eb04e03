// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/particles_on_mesh.hpp"
#include "dem_coupling/poisson_mesh.hpp"
#include "electrostatics/cell_pairs.hpp"

#include <functional>

namespace him {

/// Charges sorted by the cells of a mesh with the cells near each, for methods that work by whole cells. Holds this rank's
/// cells and copies of the cells around them.
class ChargesByCell {
public:
    /// Whether two cells of the local mesh are near each other; symmetric.
    using Near = std::function<bool(const LocalMesh&, Index, Index)>;

    /// Collective.
    /// @param reach  [m] no two cells are near whose centres lie farther apart
    ChargesByCell(const PoissonMesh& mesh, double reach, const Box& demBox, const std::array<bool, 3>& periodic,
                  MPI_Comm communicator);

    /// Lists the near cells of every own cell.
    void findNear(const Near& near);
    const IndexLists& near() const { return near_; }
    MeshHalo& halo() { return halo_; }
    const LocalMesh& mesh() const { return halo_.mesh(); }
    const MeshLocator& locator() const { return locator_; }

    /// Finds the cells of all particles. Collective.
    void locate(const DemParticles& particles) { locator_.locate(particles.position); }
    /// Brings the charges to the ranks of their cells. Collective, after locate().
    void distribute(const DemParticles& particles);
    const ChargesInCells& charges() const { return charges_; }
    /// The targets with their tags and positions, for messages.
    DemParticles targetsForMessages() const;

    /// Values of the targets, one row each, to the rows of the particles, by ParticlesOnMesh::bringBack().
    template <class Take> void bringBack(const Eigen::ArrayXXd& atTargets, const Take& take)
    {
        particlesOnMesh_.bringBack(atTargets, halo_.exchange(), take);
    }

private:
    double reach_;       ///< [m]
    double cellRadius_;  ///< largest distance of a cell's points from its centre [m]
    MeshLocator locator_;
    MeshHalo halo_;
    IndexLists near_;
    ParticlesOnMesh particlesOnMesh_;
    CloudSources sources_;
    ChargesInCells charges_;
    std::vector<std::int32_t> next_;
};

}  // namespace him
