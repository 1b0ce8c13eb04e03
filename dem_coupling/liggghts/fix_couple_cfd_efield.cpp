// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"

#include "dem_coupling/liggghts/find_fix.hpp"
#include "dem_coupling/liggghts/particle_rows.hpp"
#include "dem_coupling/near_field_refresh.hpp"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "memory.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace him {
namespace {

constexpr int width = HeldField::width;

ForceLimiter readForceLimiter(const std::vector<std::string>& words)
{
    ForceLimiter limiter;
    Complaints complaints;
    WordReader reader(words, complaints);
    while (!reader.done()) {
        const std::string keyword = reader.word("");
        if (keyword == "limit_field_force") {
            limiter.active = reader.oneOf(keyword, {"no", "yes"}) == 1;
        } else if (keyword == "field_force_limit_factor") {
            limiter.factor = readLimitFactor(reader, complaints);
        } else {
            throw std::invalid_argument("unknown keyword '" + keyword + "'; known: limit_field_force, field_force_limit_factor");
        }
    }
    if (!complaints.none()) {
        throw std::invalid_argument(complaints.text());
    }
    return limiter;
}

}  // namespace

FixCoupleCfdEfield::FixCoupleCfdEfield(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : Fix(liggghts, narg, arg)
{
    if (std::strcmp(style, "couple/cfd/efield") == 0) {
        try {
            limiter_ = readForceLimiter(std::vector<std::string>(arg + 3, arg + narg));
        } catch (const std::invalid_argument& wrong) {
            error->fix_error(FLERR, this, wrong.what());
        }
        vector_flag = 1;
        size_vector = 1;
        extvector = 0;
        global_freq = 1;
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
    memory->destroy(far_);
}

FixCoupleCfdEfield* FixCoupleCfdEfield::find(LAMMPS_NS::LAMMPS* lmp)
{
    return findFix<FixCoupleCfdEfield>(lmp);
}

void FixCoupleCfdEfield::setField(const Points& field, const Points& ownResponse)
{
    const bool knowsOwn = ownResponse.rows() == field.rows();
    for (int i = 0; i < atom->nlocal; ++i) {
        for (int d = 0; d < 3; ++d) {
            held_[i][d] = field(i, d);
            held_[i][3 + d] = atom->x[i][d];
            held_[i][HeldField::ownResponse + d] = knowsOwn ? ownResponse(i, d) : 0.0;
        }
        held_[i][6] = atom->q[i];
    }
    if (near_) {
        readRows(*atom, nearParticles_);
        near_->compute(nearParticles_, nearPart_, nearOwn_);
        const bool images = knowsOwn && nearOwn_.rows() == nearPart_.rows();
        for (int i = 0; i < atom->nlocal; ++i) {
            for (int d = 0; d < 3; ++d) {
                far_[i][d] = held_[i][d] - nearPart_(i, d);
                far_[i][3 + d] = held_[i][HeldField::ownResponse + d] - (images ? nearOwn_(i, d) : 0.0);
            }
        }
        stepsSinceNear_ = 0;
    }
    if (ghostsExist_) {
        comm->forward_comm_fix(this);
    }
}

void FixCoupleCfdEfield::fieldOfOthers(const Points& points, const std::vector<int>& leftOut, Points& field)
{
    if (!pointField_) {
        throw std::logic_error("nobody knows the field at contact points");
    }
    const Index rows = atom->nlocal;
    sources_.tag.assign(atom->tag, atom->tag + rows);
    sources_.position.resize(rows, 3);
    sources_.charge.resize(rows);
    for (Index i = 0; i < rows; ++i) {
        sources_.position.row(i) << held_[i][3], held_[i][4], held_[i][5];
        sources_.charge[i] = held_[i][6];
    }
    pointField_->fieldOfOthers(sources_, points, leftOut, field);
}

void FixCoupleCfdEfield::setNearField(NearFieldRefresh& near, long interval)
{
    near_ = &near;
    nearInterval_ = interval;
    grow_arrays(atom->nmax);
    for (int i = 0; i < atom->nlocal; ++i) {
        std::fill_n(far_[i], farWidth, 0.0);
    }
}

void FixCoupleCfdEfield::refreshNearField()
{
    readRows(*atom, nearParticles_);
    near_->compute(nearParticles_, nearPart_, nearOwn_);
    const bool images = nearOwn_.rows() == nearPart_.rows();
    for (int i = 0; i < atom->nlocal; ++i) {
        for (int d = 0; d < 3; ++d) {
            held_[i][d] = far_[i][d] + nearPart_(i, d);
            held_[i][3 + d] = atom->x[i][d];
            held_[i][HeldField::ownResponse + d] = far_[i][3 + d] + (images ? nearOwn_(i, d) : 0.0);
        }
        held_[i][6] = atom->q[i];
    }
    comm->forward_comm_fix(this);
}

int FixCoupleCfdEfield::setmask()
{
    return LAMMPS_NS::FixConst::POST_FORCE;
}

void FixCoupleCfdEfield::setup(int flag)
{
    static_cast<void>(flag);
    ghostsExist_ = true;
    addForces();
}

void FixCoupleCfdEfield::post_force(int)
{
    if (near_ && ++stepsSinceNear_ >= nearInterval_) {
        refreshNearField();
        stepsSinceNear_ = 0;
    }
    addForces();
}

void FixCoupleCfdEfield::addForces()
{
    for (int i = 0; i < atom->nlocal; ++i) {
        if (!(atom->mask[i] & groupbit)) {
            continue;
        }
        double charge = atom->q[i];
        if (limiter_.active) {
            const double* e = held_[i];
            const double strength = std::fabs(charge) * std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
            charge *= limiter_.share(strength, atom->rmass[i], neighbor->skin, update->dt);
        }
        for (int d = 0; d < 3; ++d) {
            atom->f[i][d] += charge * held_[i][d];
        }
    }
}

double FixCoupleCfdEfield::compute_limited() const
{
    double all = 0;
    MPI_Allreduce(&limiter_.hits, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

void FixCoupleCfdEfield::post_run()
{
    if (!limiter_.active) {
        return;
    }
    const double hits = compute_limited();
    if (comm->me == 0) {
        for (FILE* file : {screen, logfile}) {
            if (file) {
                std::fprintf(file, "fix %s limited the field force %.0f times (particles times steps), factor %g\n", id, hits,
                             limiter_.factor);
            }
        }
    }
}

void FixCoupleCfdEfield::grow_arrays(int rows)
{
    memory->grow(held_, rows, width, "couple/cfd/efield:held");
    array_atom = held_;
    if (near_) {
        memory->grow(far_, rows, farWidth, "couple/cfd/efield:far");
    }
}

void FixCoupleCfdEfield::copy_arrays(int from, int to, int)
{
    std::copy_n(held_[from], width, held_[to]);
    if (near_) {
        std::copy_n(far_[from], farWidth, far_[to]);
    }
}

void FixCoupleCfdEfield::set_arrays(int row)
{
    std::fill_n(held_[row], width, 0.0);
    if (near_) {
        std::fill_n(far_[row], farWidth, 0.0);
    }
    ++arrivals_;
}

int FixCoupleCfdEfield::pack_exchange(int row, double* buffer)
{
    std::copy_n(held_[row], width, buffer);
    if (!near_) {
        return width;
    }
    std::copy_n(far_[row], farWidth, buffer + width);
    return width + farWidth;
}

int FixCoupleCfdEfield::unpack_exchange(int row, double* buffer)
{
    std::copy_n(buffer, width, held_[row]);
    if (!near_) {
        return width;
    }
    std::copy_n(buffer + width, farWidth, far_[row]);
    return width + farWidth;
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
