// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_couple_cfd_drag.hpp"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "memory.h"
#include "update.h"

#include <algorithm>
#include <cstring>

namespace him {
namespace {

// Columns of a particle's row. Every DEM step reads and writes all rows, so a row is short.
constexpr int velocity = 0;  // u of the gas [m/s]
constexpr int drag = 3;      // beta [kg/s]
constexpr int gasForce = 4;  // of the gas beside drag and buoyancy [N]
constexpr int volume =
    7;  // that buoyancy acts on; it is not counted: its reaction is part of the gas's own weight [m3]
constexpr int addedMass = 8;  // [kg]
constexpr int applied = 9;    // what was counted in the last DEM step [N]
constexpr int beyond = 12;    // impulse since the forces were set, less what was promised then [N s]
constexpr int width = 15;

}  // namespace

FixCoupleCfdDrag::FixCoupleCfdDrag(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : Fix(liggghts, narg, arg)
{
    if (narg != 3) {
        error->fix_error(FLERR, this, "takes no keywords");
    }
    create_attribute = 1;
    restart_peratom = 1;
    restart_global = 1;
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

void FixCoupleCfdDrag::setForces(const GasForces& forces, double duration)
{
    const bool hasForce = forces.force.rows() > 0;
    const bool hasUnpaid = forces.unpaid.rows() > 0;
    buoyancy_ = forces.buoyancy;
    for (int i = 0; i < atom->nlocal; ++i) {
        double* row = held_[i];
        row[drag] = forces.drag[i];
        row[volume] = forces.volume[i];
        row[addedMass] = hasUnpaid ? forces.addedMass[i] : 0;
        for (int d = 0; d < 3; ++d) {
            const double promised = hasForce ? forces.force(i, d) : 0;
            row[velocity + d] = forces.velocity(i, d);
            row[gasForce + d] = promised + (hasUnpaid ? forces.unpaid(i, d) : 0);
            row[beyond + d] = -duration * (row[drag] * (row[velocity + d] - atom->v[i][d]) + promised);
        }
    }
    givenToAll_.setZero();
}

Vector3 FixCoupleCfdDrag::impulse(Points& account) const
{
    account.resize(atom->nlocal, 3);
    for (int i = 0; i < atom->nlocal; ++i) {
        for (int d = 0; d < 3; ++d) {
            account(i, d) = held_[i][beyond + d];
        }
    }
    return givenToAll_;
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
        const double inverseMass = 1 / (atom->rmass[i] + row[addedMass]);
        const double timePerMass = dt * inverseMass;
        const double beta = row[drag] / (1 + row[drag] * timePerMass);
        const double share = 1 - row[addedMass] * inverseMass;  // of m in M; exactly 1 without added mass
        for (int d = 0; d < 3; ++d) {
            const double before = atom->f[i][d];
            const double buoyancy = row[volume] * buoyancy_[d];
            const double rest = before + row[gasForce + d] + buoyancy;
            const double total = share * (rest + beta * (row[velocity + d] - atom->v[i][d] - timePerMass * rest));
            const double now = total - before - buoyancy;
            row[beyond + d] += counted * (row[applied + d] + now);
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

void FixCoupleCfdDrag::write_restart(FILE* file)
{
    if (comm->me == 0) {
        const int size = sizeof(double) * 3;
        std::fwrite(&size, sizeof(int), 1, file);
        std::fwrite(buoyancy_.data(), sizeof(double), 3, file);
    }
}

void FixCoupleCfdDrag::restart(char* buffer)
{
    std::memcpy(buoyancy_.data(), buffer, 3 * sizeof(double));
}

void FixCoupleCfdDrag::unpack_restart(int row, int nth)
{
    // The extra values of all fixes stand one after the other, each with its length in front.
    const double* extra = atom->extra[row];
    for (int fix = 0; fix < nth; ++fix) {
        extra += static_cast<int>(*extra);
    }
    if (static_cast<int>(*extra) != width + 1) {
        error->one(FLERR, "fix couple/cfd/drag: the restart file is of another version of himFoam. Continue it with that one, or "
                          "begin the run anew");
    }
    std::copy_n(extra + 1, width, held_[row]);
    restarted_ = true;
}

}  // namespace him
