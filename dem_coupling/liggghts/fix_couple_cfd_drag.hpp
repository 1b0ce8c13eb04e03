// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include "fix.h"

#include <cstdint>

namespace him {

/// fix ID group couple/cfd/drag
///
/// The gas acts on every particle by
///     F = beta (u - v)/(1 + beta dt/m) + F_gas + F_buoyancy,
/// with u, beta and the two forces held from one gas step to the next, and the velocity v of the moment. The denominator
/// makes the drag implicit in v over one DEM step dt, so that it never overshoots, however light the particle.
///
/// Each particle keeps account of the impulse that the first two terms gave it, as the integrator applies them: half of
/// dt with the force of the step before, half with that of the step itself.
class FixCoupleCfdDrag : public LAMMPS_NS::Fix {
public:
    FixCoupleCfdDrag(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
    ~FixCoupleCfdDrag() override;

    /// What acts on the owned particles from now on, in the order of their rows. The impulse account starts anew.
    void setForces(const GasForces& forces);
    /// Impulse [N s] of drag and gas force since setForces(), and what the forces promised for `duration` [s] when they were
    /// set, in the order of the rows.
    void impulse(Points& gained, double duration, Points& expected) const;
    /// Particles that appeared on this rank since this fix was made.
    std::int64_t arrivals() const { return arrivals_; }

    int setmask() override;
    void setup(int) override;
    void post_force(int) override;
    void grow_arrays(int rows) override;
    void copy_arrays(int from, int to, int deleting) override;
    void set_arrays(int row) override;
    int pack_exchange(int row, double* buffer) override;
    int unpack_exchange(int row, double* buffer) override;

private:
    /// Adds the forces of the moment. @param counted  share of dt that the forces before and now have acted by [s]
    void apply(double counted);

    double** held_ = nullptr;  ///< see the columns in the source
    std::int64_t arrivals_ = 0;
};

}  // namespace him
