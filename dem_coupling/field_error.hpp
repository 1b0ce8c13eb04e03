// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/field_method.hpp"

#include <memory>
#include <mpi.h>
#include <string>

namespace him {

struct FieldErrorSettings {
    bool active = true;
    long interval = 0;  ///< field updates between two measurements; 0: as often as the share of time allows
    long sample = 100;  ///< particles that are looked at, about
};

/// Error of a method's field at the sample, against a reference. Equal on all ranks.
struct FieldError {
    std::string failure;      ///< why nothing could be measured; empty when it was
    Index sample = 0;         ///< particles looked at
    double rms = 0;           ///< RMS|E - E_ref|/RMS|E_ref|, external field left out
    double largest = 0;       ///< max|E - E_ref|/RMS|E_ref|
    double referenceRms = 0;  ///< RMS|E_ref| [V/m]
    double seconds = 0;       ///< that the measurement took, slowest rank
};

/// A stricter p3m serves as reference on meshes of at most so many cells: its quartic stencils take about 10 kB for a cell and as
/// long to make as some hundred fields.
constexpr Index mostCellsOfReference = 50000;

/// Field of all charges and of the walls, as exact as the scene allows.
class FieldReference {
public:
    virtual ~FieldReference() = default;

    /// Adds the field [V/m] that this rank's particles and their images make at the targets, without the external field.
    /// @param ownRow  this rank's particle that sits at each target and whose own Coulomb field is left out, or -1
    /// Throws std::domain_error where it cannot.
    virtual void addField(const DemParticles& particles, const Points& targets, const std::vector<Index>& ownRow,
                          Points& field) const = 0;
    virtual std::string description() const = 0;

    /// The reference for a method: in a rectangular box of grounded, insulated or periodic sides the exact field with all
    /// images; on another mesh of not too many cells a stricter p3m (strict_p3m.hpp); without a mesh and without images the sum
    /// over all pairs. Null where there is none, or where the method is its own reference. Collective.
    /// @param mesh    may be null; outlives the reference
    /// @param reason  set to why there is none, a clause for a message
    static std::unique_ptr<FieldReference> find(const FieldSettings& settings, PoissonMesh* mesh, const Box& demBox,
                                                const std::array<bool, 3>& periodic, MPI_Comm communicator,
                                                std::string& reason);
};

/// Says every now and then how wrong the field of the run is.
class FieldErrorMonitor {
public:
    /// @param reference  may be null: then nothing is ever due
    FieldErrorMonitor(const FieldErrorSettings& settings, std::unique_ptr<FieldReference> reference,
                      const Vector3& externalField, MPI_Comm communicator);

    /// Empty when there is no reference.
    std::string reference() const { return reference_ ? reference_->description() : std::string(); }

    /// Whether to measure after this field update. The first update is always measured. Later, with an interval, every so
    /// many updates; else when the measurements so far and one more stay below `shareOfTime` of the run. Collective.
    /// @param update      number of field updates before this one
    /// @param runSeconds  wall-clock time since the start of the run
    bool due(long update, double runSeconds) const;
    static constexpr double shareOfTime = 0.02;

    /// Compares the field at a sample of the particles, chosen by tag, with the reference. Collective.
    FieldError measure(const DemParticles& particles, const Points& field);

private:
    std::vector<Index> sampleRows(const DemParticles& particles) const;

    FieldErrorSettings settings_;
    std::unique_ptr<FieldReference> reference_;
    Vector3 externalField_;
    MPI_Comm communicator_;
    double spent_ = 0;  ///< [s], slowest rank
    double last_ = 0;   ///< [s]
};

}  // namespace him
