// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/gas/drag_law.hpp"
#include "dem_coupling/gas/gas_mesh.hpp"
#include "dem_coupling/gas/gas_settings.hpp"
#include "dem_coupling/gas/particle_shares.hpp"
#include "dem_coupling/gas/velocity_profile.hpp"

#include <array>

namespace him {

/// What the particles are to the gas, one value per local cell.
struct GasSources {
    Scalars voidFraction;  ///< [-], at least GasSettings::smallestVoidFraction
    Scalars drag;          ///< sum of beta per volume [kg/(m3 s)]
    Points dragMomentum;   ///< sum of beta v per volume [N/m3]
    Points owed;           ///< impulse per volume that the gas still has to give beside drag and pressure [N s/m3]
};

/// What the gas solve has found, one value per local cell, and its sum.
struct GasResult {
    Points velocity;       ///< [m/s]
    Points pressureForce;  ///< -grad p without the hydrostatic part [N/m3]
    Points acceleration;   ///< DU/Dt [m/s2]; no rows without GasSettings::needsGasMotion()
    Points vorticity;      ///< curl U [1/s]; likewise
    /// Impulse that the gas lost in this solve otherwise than through its boundary, all ranks [N s].
    Vector3 given = Vector3::Zero();
};

/// Sums over all ranks since the start.
struct MomentumBooks {
    Vector3 given = Vector3::Zero();  ///< by the gas [N s]
    Vector3 got = Vector3::Zero();    ///< by the particles, as their integrator applied it [N s]
    /// By the forces of the last gas step for one more of the same length: what `given` is ahead of `got` [N s].
    Vector3 promised = Vector3::Zero();
    double moved = 0;  ///< sum of the sizes of all that was given [N s]
    /// What the gas gave and the particles have not got yet [N s]. Kept by itself, so that a run that continues with it rounds
    /// as the earlier one would have.
    Vector3 ahead = Vector3::Zero();
    /// What the gas gave otherwise than the particles were promised, in the last solve; the next one makes up for it, so it
    /// never accumulates. Relative to all that was moved [-].
    double mismatch() const { return moved > 0 ? (ahead - promised).norm() / moved : 0; }
};

/// Numbers of one gas step, all ranks.
struct GasSummary {
    double solidVolume = 0;  ///< of particles in the mesh [m3]
    std::int64_t particlesOutside = 0;
    std::int64_t boundedCells = 0;         ///< cells whose void fraction fell below the smallest allowed
    double boundedVolume = 0;              ///< solid volume that those cells hold above it [m3]
    double smallestVoidFraction = 1;       ///< before it was bounded
    Vector3 massCentre = Vector3::Zero();  ///< of the particles at the last sumMotion() [m]
    Vector3 momentum = Vector3::Zero();    ///< likewise [N s]
    Vector3 force = Vector3::Zero();  ///< of drag and pressure gradient on the particles, at the end of the step [N]
    std::int64_t beyondDragLaw = 0;   ///< particles where the drag law has not been shown to hold, see DragLawRange
    std::array<double, 2> voidFractionsBeyondDragLaw{1, 0};  ///< smallest and largest among those particles
    double reynoldsBeyondDragLaw = 0;    ///< largest superficial Reynolds number among them, maybe of another one
    DragLawSet othersBeyondDragLaw = 0;  ///< laws that have been shown to hold for every one of them
    std::int64_t beyondLift = 0;         ///< the same of the lift, see saffmanHolds()
};

/// The exchange of momentum between gas and particles, on any mesh and DEM. Holds no gas equation.
///
/// Order of one gas step of length dt: the DEM runs under held forces; collect() lays the particles on the mesh; the gas
/// solves with the drag implicit in its own velocity; handBack() gives velocity and pressure force to the particles. What
/// a particle then gets differs a little from what the gas gave for it, because its velocity moves on and it hits others:
/// collect() returns the difference to the gas as GasSources::owed. Momentum of gas and particles together is thus kept.
///
/// With a profile a particle feels the velocity where it is: u = U + d, with the cell's U, which the gas solve finds, and the
/// deviation d at the particle's place in the velocities before that solve. The gas gives beta (U + d - v) as well, so that
/// both agree in every cell.
class GasCoupling {
public:
    /// @param profile  of the gas velocity inside the cells; null: a particle feels the velocity of its cell
    GasCoupling(DemPort& dem, const GasMesh& mesh, const GasSettings& settings, MPI_Comm communicator,
                VelocityProfile* profile = nullptr);

    /// Lays the particles on the mesh without any drag: for the void fraction before the first step. Collective.
    void begin(const DemParticles& particles);
    /// Sources of the gas step that ends now. Collective. Throws std::runtime_error when a particle is outside the mesh and
    /// may not be.
    /// @param velocity  of the gas in every local cell, last known [m/s]
    void collect(const DemParticles& particles, const Points& velocity);
    /// Hands the gas to the particles of collect(). Collective.
    /// @param duration  of the gas step [s]
    void handBack(const DemParticles& particles, const GasResult& result, double duration);
    /// Mass centre and momentum of the particles in summary(), which cost nothing until they are asked for. Collective.
    void sumMotion(const DemParticles& particles);

    /// Takes up a run where it stopped: the gas acts on the particles as its last solve left it. Collective.
    /// @param result    of that solve
    /// @param duration  of that gas step [s]
    /// @param ahead     MomentumBooks::ahead of that time; used where the particles kept their forces
    void resume(const DemParticles& particles, const GasResult& result, double duration, const Vector3& ahead);

    const GasSources& sources() const { return sources_; }
    const GasSummary& summary() const { return summary_; }
    const MomentumBooks& books() const { return books_; }

private:
    void layVolumes(const DemParticles& particles);
    /// Throws std::runtime_error with a particle that is outside the mesh. Collective.
    [[noreturn]] void refuseOutside(const DemParticles& particles) const;
    /// beta of every particle and where the law has not been shown to hold.
    void findDrag(const DemParticles& particles, const Points& velocity);
    /// Deviation of the gas velocity at the particles from that of their cells, by the profile. After smoothColumns() of seen_.
    void findDeviations(const DemParticles& particles);
    /// Lays drag, its momentum and what is owed on the mesh. After findDrag().
    void laySources(const DemParticles& particles);
    /// Books what the particles got, and spreads what the deposit does not know of.
    void settleOwed();
    /// Lift and what the acceleration of the gas does to a particle.
    /// @param acceleration, vorticity  of the gas at the particle [m/s2], [1/s]
    void addUnpaidForces(const DemParticles& particles, Index row, const Vector3& acceleration,
                         const Vector3& vorticity);
    /// Sums over particles per volume of cells, by the void-fraction model. Collective.
    template <std::size_t N, class ValuesOf> void toCells(const ValuesOf& valuesOf, CellValues& ofCells);
    /// The void-fraction model's spreading of the first columns, per volume or value of the cells. As the adjoint of the deposit
    /// it goes before a gather, so that a particle gets what the gas gives for it.
    void smoothColumns(CellValues& ofCells, Index columns);

    DemPort& dem_;
    const GasMesh& mesh_;
    GasSettings settings_;
    MPI_Comm communicator_;
    DragOfMany law_;
    DragLawRange lawHolds_;
    VelocityProfile* profile_;  ///< or null
    ParticleShares shares_;
    GasSources sources_;
    GasForces forces_;
    GasSummary summary_;
    MomentumBooks books_;
    Index beyondDragLaw_ = 0, beyondLift_ = 0;  ///< of this rank
    std::array<double, 3> reachedBeyond_{};     ///< -smallest and largest void fraction, largest Reynolds number
    DragLawSet holdBeyond_ = 0;
    Scalars volume_;  ///< of the cells [m3]
    Scalars smoothed_;
    CellValues solid_, seen_, laid_, back_;  // apart, so that none changes its size in a steady run
    DragPoints dragPoints_;
    Scalars beta_;                     ///< of each row by model A [kg/s]
    Vector3 given_ = Vector3::Zero();  ///< to the particles in the gas step, this rank's part [N s]
    Points owed_;
    Points deviation_;  ///< of the gas velocity at each row from that of its cells [m/s]; no rows without a profile
};

}  // namespace him
