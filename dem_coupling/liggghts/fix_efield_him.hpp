// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/field_method.hpp"
#include "dem_coupling/liggghts/efield_him_options.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"

#include <memory>

namespace him {

/// fix ID group efield/him method pairwiseSum|directTruncation keyword value ...
///
/// The electric field for scenes without a host: computes it from all charges by a FieldMethod that needs no mesh, every
/// `every` steps, holds it as couple/cfd/efield does, and hands the field's settings to fix charge/gran/contact. See
/// doc/liggghts_him.md.
class FixEfieldHim : public FixCoupleCfdEfield {
public:
    FixEfieldHim(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
    ~FixEfieldHim() override;

    int setmask() override;
    void init() override;
    void setup(int flag) override;
    /// With `every 1` the field of the positions at which its force acts, else the held one.
    void post_force(int flag) override;
    void end_of_step() override;
    double compute_scalar() override { return energy_; }  ///< electrostatic energy at the last update [J]
    /// [0] largest field [V/m], [1] pairs, of the last update; [2] particles and steps whose force was limited
    double compute_vector(int n) override;

    // The held field restarts, so that a run from a restart file goes on as the one that wrote it.
    void write_restart(FILE* file) override;
    void restart(char* buffer) override;
    int pack_restart(int row, double* buffer) override;
    void unpack_restart(int row, int nth) override;
    int size_restart(int row) override;
    int maxsize_restart() override;

private:
    void checkScene();
    /// Whether the held field is missing, or belongs to particles that the script has changed since. Collective.
    bool needsUpdate() const;
    void computeField();

    EfieldHimOptions options_;
    std::unique_ptr<FieldMethod> method_;
    PhaseTimes times_;
    DemParticles particles_;
    ParticleField field_;
    bool valid_ = false;  ///< the held field of this rank's particles has been computed or read
    double energy_ = 0;
    double largestField_ = 0;
    double pairs_ = 0;
};

}  // namespace him
