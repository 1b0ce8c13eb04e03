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
constexpr int velocity = 0;    // u of the gas [m/s]
constexpr int drag = 3;        // beta [kg/s]
constexpr int gasForce = 4;    // of the gas beside drag, counted [N]
constexpr int buoyancy = 7;    // not counted: its reaction is part of the gas's own weight [N]
constexpr int applied = 10;    // what was counted in the last DEM step [N]
constexpr int promised = 13;   // what was counted when the forces were set [N]
constexpr int given = 16;      // impulse since then [N s]
constexpr int unpaid = 19;     // of the gas, counted but not promised [N]
constexpr int addedMass = 22;  // [kg]
constexpr int width = 23;

}  // namespace

FixCoupleCfdDrag::FixCoupleCfdDrag(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : Fix(liggghts, narg, arg)
{
    if (narg != 3) {
        error->fix_error(FLERR, this, "takes no keywords");
    }
    create_attribute = 1;
    restart_peratom = 1;
    just_created = 0;  // otherwise the first set-up would call set_arrays for particles that are already there
    grow_arrays(atom->nmax);
    atom->add_callback(0);  // rows grow and migrate with the particles
    atom->add_callback(1);  // and go into restart files
    for (int i = 0; i < atom->nlocal; ++i) {
        std::fill_n(held_[i], width, 0.0);
    }
    // LIGGGHTS calls unpack_restart() right after this constructor, where a restart file has rows.
}

FixCoupleCfdDrag::~FixCoupleCfdDrag()
{
    atom->delete_callback(id, 0);
    atom->delete_callback(id, 1);
    memory->destroy(held_);
}

void FixCoupleCfdDrag::setForces(const GasForces& forces)
{
    for (int i = 0; i < atom->nlocal; ++i) {
        double* row = held_[i];
        row[drag] = forces.drag[i];
        row[addedMass] = forces.addedMass.size() > 0 ? forces.addedMass[i] : 0;
        for (int d = 0; d < 3; ++d) {
            row[unpaid + d] = forces.unpaid.rows() > 0 ? forces.unpaid(i, d) : 0;
            row[velocity + d] = forces.velocity(i, d);
            row[gasForce + d] = forces.force(i, d);
            row[buoyancy + d] = forces.buoyancy(i, d);
            row[promised + d] = row[drag] * (row[velocity + d] - atom->v[i][d]) + row[gasForce + d];
            row[given + d] = 0;
        }
    }
    givenToAll_.setZero();
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

Vector3 FixCoupleCfdDrag::impulseTakenOut() const
{
    Vector3 left = givenToAll_;
    for (int i = 0; i < atom->nlocal; ++i) {
        left -= Eigen::Map<const Vector3>(held_[i] + given);
    }
    return left;
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
    Vector3 all = Vector3::Zero();
    for (int i = 0; i < atom->nlocal; ++i) {
        if (!(atom->mask[i] & groupbit)) {
            continue;
        }
        double* row = held_[i];
        const double timePerMass = dt / (atom->rmass[i] + row[addedMass]);
        const double beta = row[drag] / (1 + row[drag] * timePerMass);
        const double share = atom->rmass[i] / (atom->rmass[i] + row[addedMass]);
        for (int d = 0; d < 3; ++d) {
            const double before = atom->f[i][d];
            const double rest = before + row[gasForce + d] + row[unpaid + d] + row[buoyancy + d];
            const double total = share * (rest + beta * (row[velocity + d] - atom->v[i][d] - timePerMass * rest));
            const double now = total - before - row[buoyancy + d];
            row[given + d] += counted * (row[applied + d] + now);
            row[applied + d] = now;
            all[d] += now;
            atom->f[i][d] = total;
        }
    }
    givenToAll_ += counted * (appliedToAll_ + all);
    appliedToAll_ = all;
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

int FixCoupleCfdDrag::size_restart(int)
{
    return width + 1;
}

int FixCoupleCfdDrag::maxsize_restart()
{
    return width + 1;
}

int FixCoupleCfdDrag::pack_restart(int row, double* buffer)
{
    buffer[0] = width + 1;
    std::copy_n(held_[row], width, buffer + 1);
    return width + 1;
}

void FixCoupleCfdDrag::unpack_restart(int row, int nth)
{
    // The extra values of all fixes stand one after the other, each with its length in front.
    const double* extra = atom->extra[row];
    for (int fix = 0; fix < nth; ++fix) {
        extra += static_cast<int>(*extra);
    }
    std::copy_n(extra + 1, width, held_[row]);
    restarted_ = true;
}

}  // namespace him
