// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_couple_cfd_drag.hpp"

#include "atom.h"
#include "error.h"
#include "memory.h"
#include "update.h"

#include <algorithm>

namespace him {
namespace {

// Columns of a particle's row.
constexpr int velocity = 0;   // u of the gas [m/s]
constexpr int drag = 3;       // beta [kg/s]
constexpr int gasForce = 4;   // of the gas beside drag, counted [N]
constexpr int buoyancy = 7;   // not counted: its reaction is part of the gas's own weight [N]
constexpr int applied = 10;   // what was counted in the last DEM step [N]
constexpr int promised = 13;  // what was counted when the forces were set [N]
constexpr int given = 16;     // impulse since then [N s]
constexpr int width = 19;

}  // namespace

FixCoupleCfdDrag::FixCoupleCfdDrag(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : Fix(liggghts, narg, arg)
{
    if (narg != 3) {
        error->fix_error(FLERR, this, "takes no keywords");
    }
    create_attribute = 1;
    just_created = 0;  // otherwise the first set-up would call set_arrays for particles that are already there
    grow_arrays(atom->nmax);
    atom->add_callback(0);
    for (int i = 0; i < atom->nlocal; ++i) {
        std::fill_n(held_[i], width, 0.0);
    }
}

FixCoupleCfdDrag::~FixCoupleCfdDrag()
{
    atom->delete_callback(id, 0);
    memory->destroy(held_);
}

void FixCoupleCfdDrag::setForces(const GasForces& forces)
{
    for (int i = 0; i < atom->nlocal; ++i) {
        double* row = held_[i];
        row[drag] = forces.drag[i];
        for (int d = 0; d < 3; ++d) {
            row[velocity + d] = forces.velocity(i, d);
            row[gasForce + d] = forces.force(i, d);
            row[buoyancy + d] = forces.buoyancy(i, d);
            row[promised + d] = row[drag] * (row[velocity + d] - atom->v[i][d]) + row[gasForce + d];
            row[given + d] = 0;
        }
    }
}

void FixCoupleCfdDrag::impulse(Points& gained, double duration, Points& expected) const
{
    gained.resize(atom->nlocal, 3);
    expected.resize(atom->nlocal, 3);
    for (int i = 0; i < atom->nlocal; ++i) {
        for (int d = 0; d < 3; ++d) {
            gained(i, d) = held_[i][given + d];
            expected(i, d) = held_[i][promised + d] * duration;
        }
    }
}

int FixCoupleCfdDrag::setmask()
{
    return LAMMPS_NS::FixConst::POST_FORCE;
}

void FixCoupleCfdDrag::setup(int)
{
    apply(0);  // no time passes in a set-up
}

void FixCoupleCfdDrag::post_force(int)
{
    apply(0.5 * update->dt);
}

void FixCoupleCfdDrag::apply(double counted)
{
    const double dt = update->dt;
    for (int i = 0; i < atom->nlocal; ++i) {
        if (!(atom->mask[i] & groupbit)) {
            continue;
        }
        double* row = held_[i];
        const double beta = row[drag] / (1 + row[drag] * dt / atom->rmass[i]);
        for (int d = 0; d < 3; ++d) {
            const double now = beta * (row[velocity + d] - atom->v[i][d]) + row[gasForce + d];
            row[given + d] += counted * (row[applied + d] + now);
            row[applied + d] = now;
            atom->f[i][d] += now + row[buoyancy + d];
        }
    }
}

void FixCoupleCfdDrag::grow_arrays(int rows)
{
    memory->grow(held_, rows, width, "couple/cfd/drag:held");
}

void FixCoupleCfdDrag::copy_arrays(int from, int to, int)
{
    std::copy_n(held_[from], width, held_[to]);
}

void FixCoupleCfdDrag::set_arrays(int row)
{
    std::fill_n(held_[row], width, 0.0);
    ++arrivals_;
}

int FixCoupleCfdDrag::pack_exchange(int row, double* buffer)
{
    std::copy_n(held_[row], width, buffer);
    return width;
}

int FixCoupleCfdDrag::unpack_exchange(int row, double* buffer)
{
    std::copy_n(buffer, width, held_[row]);
    return width;
}

}  // namespace him
