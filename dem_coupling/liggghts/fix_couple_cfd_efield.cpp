// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"

#include "dem_coupling/charging/charge_transfer.hpp"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "memory.h"
#include "modify.h"

#include <algorithm>
#include <cstring>

namespace him {
namespace {

constexpr int width = HeldField::width;

}  // namespace

FixCoupleCfdEfield::FixCoupleCfdEfield(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : Fix(liggghts, narg, arg)
{
    if (narg != 3 && std::strcmp(style, "couple/cfd/efield") == 0) {
        error->fix_error(FLERR, this, "takes no keywords");
    }
    if (!atom->q_flag) {
        error->fix_error(FLERR, this, "needs charged particles: write 'atom_style hybrid granular charge'");
    }
    create_attribute = 1;
    just_created = 0;  // otherwise the first set-up would call set_arrays for particles that are already there
    comm_forward = width;
    comm_border = width;
    peratom_flag = 1;
    size_peratom_cols = width;
    peratom_freq = 1;
    grow_arrays(atom->nmax);
    atom->add_callback(0);
    atom->add_callback(2);
    for (int i = 0; i < atom->nlocal; ++i) {
        std::fill_n(held_[i], width, 0.0);
    }
}

FixCoupleCfdEfield::~FixCoupleCfdEfield()
{
    atom->delete_callback(id, 0);
    atom->delete_callback(id, 2);
    memory->destroy(held_);
}

FixCoupleCfdEfield* FixCoupleCfdEfield::find(LAMMPS_NS::LAMMPS* lmp)
{
    for (int i = 0; i < lmp->modify->nfix; ++i) {
        if (auto* field = dynamic_cast<FixCoupleCfdEfield*>(lmp->modify->fix[i])) {
            return field;
        }
    }
    return nullptr;
}

void FixCoupleCfdEfield::setField(const Points& field)
{
    for (int i = 0; i < atom->nlocal; ++i) {
        for (int d = 0; d < 3; ++d) {
            held_[i][d] = field(i, d);
            held_[i][3 + d] = atom->x[i][d];
        }
        held_[i][6] = atom->q[i];
    }
    if (ghostsExist_) {
        comm->forward_comm_fix(this);
    }
}

int FixCoupleCfdEfield::setmask()
{
    return LAMMPS_NS::FixConst::POST_FORCE;
}

void FixCoupleCfdEfield::setup(int flag)
{
    ghostsExist_ = true;
    post_force(flag);
}

void FixCoupleCfdEfield::post_force(int)
{
    for (int i = 0; i < atom->nlocal; ++i) {
        if (atom->mask[i] & groupbit) {
            for (int d = 0; d < 3; ++d) {
                atom->f[i][d] += atom->q[i] * held_[i][d];
            }
        }
    }
}

void FixCoupleCfdEfield::grow_arrays(int rows)
{
    memory->grow(held_, rows, width, "couple/cfd/efield:held");
    array_atom = held_;
}

void FixCoupleCfdEfield::copy_arrays(int from, int to, int)
{
    std::copy_n(held_[from], width, held_[to]);
}

void FixCoupleCfdEfield::set_arrays(int row)
{
    std::fill_n(held_[row], width, 0.0);
    ++arrivals_;
}

int FixCoupleCfdEfield::pack_exchange(int row, double* buffer)
{
    std::copy_n(held_[row], width, buffer);
    return width;
}

int FixCoupleCfdEfield::unpack_exchange(int row, double* buffer)
{
    std::copy_n(buffer, width, held_[row]);
    return width;
}

int FixCoupleCfdEfield::pack_border(int n, int* list, double* buffer)
{
    for (int k = 0; k < n; ++k) {
        std::copy_n(held_[list[k]], width, buffer + k * width);
    }
    return n * width;
}

int FixCoupleCfdEfield::unpack_border(int n, int first, double* buffer)
{
    for (int k = 0; k < n; ++k) {
        std::copy_n(buffer + k * width, width, held_[first + k]);
    }
    return n * width;
}

int FixCoupleCfdEfield::pack_comm(int n, int* list, double* buffer, int, int*)
{
    pack_border(n, list, buffer);
    return width;
}

void FixCoupleCfdEfield::unpack_comm(int n, int first, double* buffer)
{
    unpack_border(n, first, buffer);
}

}  // namespace him
