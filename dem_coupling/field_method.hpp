// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/field_settings.hpp"
#include "dem_coupling/phase_times.hpp"
#include "dem_coupling/point_field.hpp"
#include "dem_coupling/poisson_mesh.hpp"

#include <memory>
#include <mpi.h>
#include <optional>
#include <string>
#include <vector>

namespace him {

/// Field at this rank's particles, in the order of DemParticles.
struct ParticleField {
    Points field;               ///< [V/m], own self-field excluded
    Scalars potential;          ///< [V], without the own Coulomb term; empty when the method has none
    double excludedCharge = 0;  ///< [C] of particles outside the mesh, all ranks
    std::int64_t excludedCount = 0;
    std::int64_t pairs = 0;  ///< near pairs, all ranks
    /// Electrostatic energy [J] of this rank's particles: 1/2 sum q V of the charges' own potential plus sum q V of the
    /// external field; NaN when the method has no potential.
    double energy = 0;
    /// Share of `field` that the particle's own images and induced charges make [V/m], so that field - ownResponse is the
    /// field of the others; empty when the method does not know it or FieldSettings does not ask for it.
    Points ownResponse;
};

/// Largest field that a method's mesh makes of a particle's charge at the particle's own cell, though it should make none.
struct OwnCellField {
    double share = 0;  ///< of the field at the particle's surface, q/(4 pi eps r^2) [-]
    int tag = 0;       ///< the particle; 0 when no cell is uneven
};

/// A way to get the field at every particle from all charges. compute() is collective.
class FieldMethod {
public:
    virtual ~FieldMethod() = default;

    /// Known names, in the order of the documentation.
    static const std::vector<std::string>& names();
    static bool needsMesh(const std::string& name);
    static bool needsCutoff(const std::string& name);
    /// Whether the method can give the field at contact points.
    static bool knowsPoints(const std::string& name);
    /// Why `wallField atContactPoint` is refused with this method.
    static std::string noPointsText(const std::string& name);

    /// Everything that is wrong with these settings: unknown name, cutoff not positive, below the largest cell diagonal
    /// or above a period, periodic box where the method has none. Not collective.
    static Complaints check(const FieldSettings& settings, const PoissonMesh* mesh, const Box& demBox,
                            const std::array<bool, 3>& periodic);

    /// The method of that name. Throws std::invalid_argument with all complaints of check(); an unknown name lists the
    /// known ones. `mesh` may be null for a method that needs none and outlives the method. Collective.
    static std::unique_ptr<FieldMethod> create(const FieldSettings& settings, PoissonMesh* mesh, const Box& demBox,
                                               const std::array<bool, 3>& periodic, MPI_Comm communicator,
                                               PhaseTimes& times);

    /// No field at all, for scenes without electrostatics.
    static std::unique_ptr<FieldMethod> none();

    /// Field of all charges at these particles, plus the external field. Throws std::runtime_error, the same on every
    /// rank, when two particles share a position or one is outside a mesh that should hold it.
    virtual void compute(const DemParticles& particles, ParticleField& result) = 0;

    /// Of the particles last given to compute(), those in the most uneven cells away from walls; nothing where a method has no
    /// such field, or takes it out. Costs a few Poisson solves and leaves no trace of them. Collective.
    virtual std::optional<OwnCellField> ownCellField(const DemParticles& particles)
    {
        static_cast<void>(particles);
        return std::nullopt;
    }

    /// The field at contact points; null where knowsPoints() of its name is false.
    virtual PointField* pointField() { return nullptr; }

    /// What charging sees of the walls' response to a particle's own charge in spite of ParticleField::ownResponse, in words; empty
    /// where it sees none, or where the settings alone tell. After the first compute().
    virtual std::string ownResponseText() const { return {}; }

    /// See DemPort::setPartnerCutoff.
    virtual double partnerCutoff() const = 0;
    virtual bool hasPotential() const = 0;
};

}  // namespace him
