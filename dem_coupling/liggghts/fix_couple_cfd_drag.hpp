// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include "fix.h"

#include <cstdint>
#include <cstdio>

namespace him {

/// fix ID group couple/cfd/drag
///
/// The gas acts on every particle by
///     F_drag = beta (u - v - dt F/M)/(1 + beta dt/M),   M = m + m_added,
/// with F all other forces (those of fixes and pairs before this one, pressure gradient, buoyancy, lift), and u, beta, m_added
/// and the forces of the gas held from one gas step to the next; v is the velocity of the moment. The drag is thus implicit in
/// the velocity that the DEM step dt ends with: it never overshoots, however light the particle, and in balance with a weight
/// the slip is exactly weight/beta. The added mass takes its share of every acceleration: (F + F_drag) m/M is applied.
///
/// Each particle keeps account of the impulse that the gas gave it beyond what it was promised, buoyancy left out, as the
/// integrator applies it: half of dt with the force of the step before, half with that of the step itself. Account and forces go
/// into restart files. All that was given is summed as well: LIGGGHTS takes particles out between the two halves of a step
/// (pre_exchange, and at open ends of the box), and what they got until then, the first half included, is in the sum alone.
class FixCoupleCfdDrag : public LAMMPS_NS::Fix {
public:
    FixCoupleCfdDrag(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
    ~FixCoupleCfdDrag() override;

    /// What acts on the owned particles from now on, in the order of their rows. Both accounts start anew.
    /// @param duration  for which drag and force of this moment are promised [s]
    void setForces(const GasForces& forces, double duration);
    /// Impulse [N s] of the gas since setForces() beyond what was promised, in the order of the rows.
    /// @return all impulse since then; the sum over all ranks counts
    Vector3 impulse(Points& account) const;
    /// Particles that appeared on this rank since this fix was made.
    std::int64_t arrivals() const { return arrivals_; }
    /// Whether the rows of this rank came from a restart file.
    bool restarted() const { return restarted_; }

    int setmask() override;
    void setup(int) override;
    void post_force(int) override;
    void grow_arrays(int rows) override;
    void copy_arrays(int from, int to, int deleting) override;
    void set_arrays(int row) override;
    int pack_exchange(int row, double* buffer) override;
    int unpack_exchange(int row, double* buffer) override;
    int pack_restart(int row, double* buffer) override;
    void unpack_restart(int row, int nth) override;
    int size_restart(int row) override;
    int maxsize_restart() override;
    void write_restart(FILE* file) override;
    void restart(char* buffer) override;

private:
    /// Adds the forces of the moment. @param counted  share of dt that the forces before and now have acted by [s]
    void apply(double counted);

    double** held_ = nullptr;                 ///< see the columns in the source
    Vector3 buoyancy_ = Vector3::Zero();      ///< per volume [N/m3]
    Vector3 appliedToAll_ = Vector3::Zero();  ///< what was counted in the last DEM step, this rank's rows of then [N]
    Vector3 givenToAll_ = Vector3::Zero();    ///< impulse since setForces(), of those that were taken out too [N s]
    std::int64_t arrivals_ = 0;
    bool restarted_ = false;
};

}  // namespace him
