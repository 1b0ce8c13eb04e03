// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/exchange/particle_halo.hpp"
#include "dem_coupling/field_methods/wall_images.hpp"
#include "dem_coupling/phase_times.hpp"
#include "dem_coupling/poisson_mesh.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/p3m/cloud.hpp"

#include <memory>

namespace him {

/// The part of the field that changes fastest: that of charges nearer than the reach, less the field of their clouds of that
/// radius (see electrostatics/doc on p3m), with their images in plane conductors. It vanishes smoothly at the reach. A held
/// field less this part at the held positions, plus this part now, follows the particles between two field updates; what is
/// left behind, the field of the clouds, varies over lengths of the reach.
class NearFieldRefresh {
public:
    /// The one that settings.nearField asks for, handed to the DEM; null where the case holds the whole field. Images move with
    /// the particles where the field method knows them (p3m, pairwiseSum). `mesh` may be null without a mesh. Collective.
    static std::unique_ptr<NearFieldRefresh> create(const FieldSettings& settings, const PoissonMesh* mesh,
                                                    DemPort& dem, MPI_Comm communicator, PhaseTimes& times);

    /// @param reach   [m]
    /// @param planes  conductors with image charges; may be empty. Only those of Shape::plane
    NearFieldRefresh(double reach, double permittivity, const std::vector<ImageWall>& planes, const Box& demBox,
                     const std::array<bool, 3>& periodic, MPI_Comm communicator, PhaseTimes& times,
                     NearPrecision precision = NearPrecision::doublePrecision);

    /// Field [V/m] of all charges at this rank's particles, and the share of each particle's own images (no rows without
    /// planes). Collective. Throws std::runtime_error, the same on every rank, when two particles share a position.
    void compute(const DemParticles& particles, Points& field, Points& ownImages);

    /// heldFieldFrequency() [1/s] over all ranks, of the field of an update less what the last compute() found. `particles` and `field`
    /// are those of that update. Collective.
    double heldFrequency(const DemParticles& particles, const Points& field) const;

private:
    /// Adds the images that can reach a particle to the sources, and their field on their owners to ownImages.
    void addImages(Index particles, Points& ownImages);
    /// Largest height of a point above the conductors' planes [m]; negative in the space of the particles.
    double heightAbovePlanes(const Vector3& point) const;

    double reach_;
    double permittivity_;
    std::vector<ImageWall> planes_;
    WallImages walls_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    ParticleHalo halo_;
    NearField near_;
    NearPrecision precision_;
    ChargeCloud cloud_;
    ChargedPoints points_;
    PairSumResult sums_;
    WallImages::Set images_;
    Points nearWalls_;
    Scalars chargeNearWalls_;
    std::vector<Index> rowNearWalls_;
};

}  // namespace him
