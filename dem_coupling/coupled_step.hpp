// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charge_books.hpp"
#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/field_method.hpp"
#include "dem_coupling/phase_times.hpp"
#include "dem_coupling/wall_charge_port.hpp"

#include <functional>
#include <mpi.h>
#include <utility>

namespace him {

/// Global numbers of one field update, equal on every rank.
struct StepSummary {
    std::int64_t particles = 0;
    double totalCharge = 0;     ///< [C]
    double smallestCharge = 0;  ///< [C]
    double largestCharge = 0;   ///< [C]
    double largestField = 0;    ///< [V/m]
    double fieldFrequency = 0;  ///< [1/s], see fieldFrequency()
    double heldFrequency = 0;   ///< [1/s], with a near field that follows: of what stays held, see heldFieldFrequency()
    double energy = 0;          ///< electrostatic [J], see ParticleField::energy; NaN when the method has no potential
    double kineticEnergy = 0;   ///< translational [J]
    std::int64_t excludedCount = 0;  ///< particles outside the mesh
    double excludedCharge = 0;       ///< [C]
};

/// One coupled step: DEM sub-steps under a held field, then a new field from the moved charges, then the books.
/// Holds no physics of its own.
class CoupledStep {
public:
    CoupledStep(DemPort& dem, FieldMethod& field, MPI_Comm communicator, PhaseTimes& times);

    /// Where insulating walls keep their charge; before start(), outlives this.
    void setWallCharges(WallChargePort* walls) { walls_ = walls; }

    /// What follows the particles between two updates, for StepSummary::heldFrequency; before start(), outlives this. The DEM
    /// must have it.
    void setNearField(const NearFieldRefresh* near) { near_ = near; }

    /// Something that may change the charges of the particles, in `particles` and in the DEM alike, in every step between the DEM
    /// steps and the field. What it gives to insulating walls must be on their faces afterwards. Returns whether it did.
    using ChargeChange = std::function<bool(DemParticles& particles)>;
    void setChargeChange(ChargeChange change) { changeCharges_ = std::move(change); }

    /// Tells the DEM the method's partner cutoff, computes the field of the first step, opens the books and hands over.
    /// Call once. Throws like advance().
    void start();
    /// `demSteps` DEM steps, then updateField(). Throws std::runtime_error naming the particle when one is lost or
    /// becomes NaN, and when the charge books do not close.
    void advance(long demSteps);

    const DemParticles& particles() const { return particles_; }
    const ParticleField& field() const { return field_; }
    const StepSummary& summary() const { return summary_; }
    const ChargeBooks& books() const { return books_; }
    bool hasInsulatingWalls() const { return walls_ != nullptr; }
    /// Charge on the faces of insulating walls [C], all ranks.
    double wallFaceCharge() const { return wallFaceCharge_; }
    /// What the faces hold beyond what the books say that their walls were given since the start [C].
    double wallFaceError() const;

private:
    void readParticles();
    void updateField();
    void bringWallCharges();
    double givenToKeepingWalls() const;
    void summarise();

    DemPort& dem_;
    FieldMethod& method_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    DemParticles particles_;
    DemParticles previous_;
    ParticleField field_;
    StepSummary summary_;
    ChargeBooks books_;
    WallChargePort* walls_ = nullptr;
    const NearFieldRefresh* near_ = nullptr;
    ChargeChange changeCharges_;
    std::vector<WallCharge> wallCharges_;
    double wallFaceCharge_ = 0;   ///< [C]
    double wallFaceOpening_ = 0;  ///< on the faces beyond what their walls were given when the books were opened [C]
    double absoluteCharge_ = 0;
    bool booksOpen_ = false;
};

}  // namespace him
