// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/complaints.hpp"
#include "dem_coupling/field_settings.hpp"
#include "dem_coupling/wall_equilibrium.hpp"
#include "electrostatics/types.hpp"

#include <array>
#include <memory>
#include <mpi.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace him {

class NearFieldRefresh;

/// The particles that this rank's DEM owns. Row order is the DEM's own and may change with every run().
struct DemParticles {
    std::vector<int> tag;   ///< unique over all ranks, from 1
    std::vector<int> type;  ///< DEM atom type, from 1
    Points position;        ///< [m]
    Points velocity;        ///< [m/s]
    Scalars charge;         ///< [C]
    Scalars radius;         ///< [m]
    Scalars mass;           ///< [kg]

    Index size() const { return static_cast<Index>(tag.size()); }
};

/// Numbers that the host keeps with the particles: one row each.
using Notes = Eigen::ArrayXXd;

/// One wall of the DEM scene: a primitive wall fix, or one mesh of a mesh wall fix.
struct DemWall {
    std::string name;            ///< id of the primitive wall fix or of the mesh fix
    std::string shape;           ///< "zplane", "zcylinder", ..., or "mesh"
    int type = 0;                ///< DEM atom type of its material
    bool chargingModel = false;  ///< its contact model records contacts for charging
    bool primitive = false;      ///< a plane or cylinder, described by `image`
    ImageWall image = {};        ///< of a primitive wall; the side of a plane's normal is arbitrary
};

/// How the gas acts on particles from one gas step to the next: drag (velocity - v) + force + unpaid + buoyancy volume. One
/// row per particle.
struct GasForces {
    Points velocity;  ///< of the gas at the particle [m/s]
    Scalars drag;     ///< beta [kg/s], at least 0
    /// Hydrostatic, per volume of the particle; it is balanced within the gas's own weight [N/m3].
    Vector3 buoyancy = Vector3::Zero();
    Scalars volume;  ///< of the particle that buoyancy acts on: 0 outside the mesh [m3]
    // No rows where nothing asks for them.
    Points force;  ///< of the gas beside drag, which the gas loses [N]
    // The gas does not lose these in its solve: it pays for the impulse afterwards.
    Points unpaid;      ///< lift, and added mass times the acceleration of the gas [N]
    Scalars addedMass;  ///< gas that a particle drags along when it is accelerated [kg]
};

/// How a DEM wall takes part in charging, decided by the case.
struct WallRole {
    std::string name;  ///< DemWall::name
    bool transfersCharge = true;
    bool keepsCharge = false;  ///< an insulating wall: what its contacts leave is handed over, see takeWallCharges
};

/// What contacts at one place left on an insulating wall.
struct WallCharge {
    Vector3 point;      ///< contact point [m]
    int wall = 0;       ///< row of DemPort::walls()
    double charge = 0;  ///< that the wall gained [C]
};

/// Which field of the others drives charging at a wall.
enum class WallContactField { total, self };

/// Charge that has left or entered the particles since the hand-over [C], summed over ranks.
struct ChargeMovements {
    std::vector<double> toWall;  ///< one per wall, in the order of DemPort::walls()
    double inserted = 0;         ///< carried by particles that appeared
    double removed = 0;          ///< carried by particles that were taken out
    double leaked = 0;           ///< lost to ground through leakage
    double breakdown = 0;        ///< lost to dielectric breakdown
};

/// Contact statistics since the hand-over, summed over ranks.
struct ContactCounts {
    double particleParticle = 0;  ///< contacts that began
    double particleWall = 0;
    double largestRelaxation = 0;  ///< largest M of one contact in one step [-], see chargeGained
    double strongFrozen = 0;       ///< contacts whose x passed 0.5 under `update frozen`: they may overshoot
    double breakdowns = 0;         ///< times that the breakdown limit took charge off a particle
    double limitedForces = 0;      ///< particles and steps whose field force was limited
};

/// What the coupling needs of a DEM program. SI units. Collective over the communicator unless said otherwise.
class DemPort {
public:
    virtual ~DemPort() = default;

    // --- the scene, valid after construction
    virtual double timeStep() const = 0;  ///< [s]
    virtual Box box() const = 0;          ///< whole DEM box [m]
    virtual std::array<bool, 3> periodic() const = 0;
    virtual const std::vector<DemWall>& walls() const = 0;
    virtual int particleTypes() const = 0;  ///< of particles and walls, from 1 to this
    /// The plane that the script confines particles to, "(nx ny nz) through (x y z) m"; empty where they move freely.
    virtual std::string planeOfMotion() const { return {}; }
    virtual bool charging() const = 0;                    ///< the script asks for contact charging
    virtual std::string chargingDescription() const = 0;  ///< the pair table for the log, several lines
    /// What in the scene can not be simulated (missing Gamma for a type pair, coarse graining, wrong units, ...).
    virtual Complaints check() const = 0;
    /// Corners [m] of this rank's facets of a mesh wall; empty for a primitive one. Not collective.
    virtual std::vector<Vector3> wallPoints(std::size_t wall) const
    {
        static_cast<void>(wall);
        return {};
    }
    virtual bool ranBeforeHandOver() const = 0;  ///< the script contained `run`

    // --- settings, before the first run()
    virtual void setWallRoles(const std::vector<WallRole>& roles) = 0;
    virtual void setWallContactField(WallContactField field) = 0;
    virtual void setPermittivity(double permittivity) = 0;  ///< [F/m]
    /// Distance [m] up to which the field handed over by setField contains the Coulomb field of a particle's neighbour;
    /// infinity for a full pair sum. Needed to take the contact partner out of it.
    virtual void setPartnerCutoff(double cutoff) = 0;
    /// From now on the held field follows the particles: its short-range part is computed anew after every `interval` DEM
    /// steps, at the positions at which it acts. `near` outlives the DEM's runs.
    virtual void setNearField(NearFieldRefresh& near, long interval)
    {
        static_cast<void>(near);
        static_cast<void>(interval);
        throw std::logic_error("this DEM can not compute near fields between two field updates");
    }
    /// Whether the DEM may take particles out during the run. If not, every missing one counts as lost.
    virtual void allowRemovals(bool allowed) = 0;
    /// Gives the particles of the script their initial charge, where it asks for one. Before the first field.
    virtual void chargeParticles() {}
    /// Switches field force and charging on and computes the forces of the first step. No charge moves here.
    virtual void handOver() = 0;

    // --- the run
    virtual void particles(DemParticles& out) const = 0;  ///< this rank's particles, not collective
    /// Hands over the field [V/m] of the particles last given by particles(), in the same order, together with the
    /// positions and charges that made it.
    /// @param ownResponse  share of the field that each particle's own images make, or no rows; see ParticleField
    virtual void setField(const DemParticles& particles, const Points& field, const Points& ownResponse) = 0;
    virtual void run(long steps) = 0;
    /// Hands over what the gas does to the particles last given by particles(), in the same order. Before the first call no
    /// gas acts.
    /// @param duration  how long they are going to act, for gasImpulse() [s]
    virtual void setGasForces(const GasForces& forces, double duration) = 0;
    /// Whether the particles of a checkpoint brought the gas forces of its time with them. After handOver().
    virtual bool gasForcesRestarted() const { return false; }
    /// Impulse [N s] that the gas has given each particle since setGasForces(), buoyancy left out, beyond what drag and force
    /// promised for the duration told there with the velocities of that moment; in the order of particles(), not collective.
    /// Zeros before the first setGasForces().
    /// @return all impulse of the gas since then, also to particles that were taken out. This rank's part of a sum that means
    ///         something over all ranks only
    virtual Vector3 gasImpulse(Points& beyond) const = 0;
    /// Particles that there must be, all ranks: those of the hand-over and those that appeared, less those that were taken
    /// out with permission.
    virtual std::int64_t particleCount() const = 0;

    // --- the books
    virtual ChargeMovements movements() const = 0;
    virtual ContactCounts contacts() const = 0;
    /// Charges that this rank's contacts left on walls that keep them, since the last call; then forgets them. Not collective.
    virtual void takeWallCharges(std::vector<WallCharge>& out) { out.clear(); }

    // --- charges that the host sets
    /// Ends all charging: from the hand-over on contacts move no charge and particles lose none. Before handOver().
    virtual void stopCharging() {}
    /// Whether particles lose charge elsewhere than at contacts (leakage, breakdown).
    virtual bool losesCharge() const { return false; }
    /// Replaces the charges [C] of the particles last given by particles(); setField() must follow. Not collective.
    virtual void setCharges(const Scalars& charge) { static_cast<void>(charge); }
    /// Enters into the books what the host gave to the walls [C] in the order of walls(), the same on every rank.
    virtual void giveToWalls(const std::vector<double>& charge) { static_cast<void>(charge); }
    /// Keeps numbers of the host with every particle: they travel with it and go into checkpoints; new particles start with
    /// zeros. Before handOver(); the numbers of a checkpoint are there afterwards.
    virtual void keepNotes(int columns) { static_cast<void>(columns); }
    /// One row per particle, in the order of particles(). Not collective.
    virtual void notes(Notes& out) const { out.resize(0, 0); }
    virtual void setNotes(const Notes& notes) { static_cast<void>(notes); }

    // --- what is measured on request
    /// Radius of the largest particle that is there or that the script can insert, all ranks [m]. Collective.
    virtual double largestRadius() const { return 0; }
    /// Gravity [m/s2]; zero where the script has none.
    virtual Vector3 gravity() const { return Vector3::Zero(); }
    /// The factor a on every charge transfer; 1 without charging.
    virtual double chargingAcceleration() const { return 1; }
    /// Equilibrium charges of the particles that are there at the walls that charge them, empty without such. After
    /// setWallRoles() and setPermittivity(). Collective.
    virtual std::vector<WallEquilibrium> equilibria() const { return {}; }
    /// Makes the DEM keep the forces of contacts with walls. Returns the names of the wall fixes; one that holds several meshes
    /// is one wall here. Before handOver(); what nobody asks for costs nothing.
    virtual std::vector<std::string> keepWallForces() { return {}; }
    /// Forces [N] of each of these walls' contacts on this rank's particles in the last DEM step, in the order of particles().
    /// Not collective.
    virtual void wallForces(std::vector<Points>& out) const { out.clear(); }
    /// Writes a restart file. The next run() computes all forces anew, as a run from that file does, so that both go on
    /// bit for bit alike.
    virtual void writeCheckpoint(const std::string& file) = 0;
};

struct DemOptions {
    std::string script;       ///< path of the LIGGGHTS script
    std::string directory;    ///< directory in which its relative paths are meant
    std::string logFile;      ///< LIGGGHTS log
    bool needsCharge = true;  ///< particles must have a charge; false for a gas without electrostatics
    bool hasGas = false;      ///< setGasForces() will be called; false costs nothing
    /// LIGGGHTS index variables that the script finds set, name and value (as `-var name value` on its command line).
    std::vector<std::pair<std::string, std::string>> variables;
};

/// Starts LIGGGHTS, registers our styles and reads the script. LIGGGHTS' own message reaches stdout when it rejects
/// the script; the process then ends. One instance per process.
std::unique_ptr<DemPort> openLiggghts(const DemOptions& options, MPI_Comm communicator);

}  // namespace him
