// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_efield_him.hpp"

#include "dem_coupling/charging/held_field.hpp"
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"
#include "dem_coupling/liggghts/particle_rows.hpp"
#include "dem_coupling/liggghts/wall_list.hpp"
#include "dem_coupling/particle_faults.hpp"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace him {

namespace {

constexpr int width = HeldField::width;

/// Complaints of FieldMethod::check() without the names of a case's dictionaries.
Complaints inWordsOfTheScript(const Complaints& complaints)
{
    Complaints plain;
    for (const std::string& line : complaints.lines()) {
        const std::size_t colon = line.find(": ");
        const bool cutoff = line.substr(0, colon).find("Cutoff") != std::string::npos;
        plain.add(cutoff ? "cutoff" : "method", line.substr(colon + 2));
    }
    return plain;
}

}  // namespace

FixEfieldHim::FixEfieldHim(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : FixCoupleCfdEfield(liggghts, narg, arg)
{
    if (find(lmp)) {
        error->fix_error(FLERR, this, "there is already a fix that holds the electric field; one is enough");
    }
    if (std::strcmp(update->unit_style, "si") != 0) {
        error->fix_error(FLERR, this, "works in 'units si' only");
    }
    if (!atom->radius_flag) {
        error->fix_error(FLERR, this, "needs spheres: write 'atom_style hybrid granular charge'");
    }
    try {
        options_ = readEfieldHimOptions(std::vector<std::string>(arg + 3, arg + narg));
    } catch (const std::invalid_argument& wrong) {
        error->fix_error(FLERR, this, wrong.what());
    }
    limiter_ = options_.limiter;
    nevery = static_cast<int>(options_.every);
    restart_peratom = 1;
    restart_global = 1;
    scalar_flag = 1;
    extscalar = 1;
    vector_flag = 1;
    size_vector = 3;
    extvector = 0;
    global_freq = 1;
    atom->add_callback(1);
}

FixEfieldHim::~FixEfieldHim()
{
    atom->delete_callback(id, 1);
}

int FixEfieldHim::setmask()
{
    return FixCoupleCfdEfield::setmask() | LAMMPS_NS::FixConst::END_OF_STEP;
}

void FixEfieldHim::checkScene()
{
    Complaints complaints;
    if (domain->dimension == 2) {
        complaints.add("dimension 2", "particles would be discs of unit length, and their field is not that of charged "
                                      "spheres. Use 'dimension 3' and 'fix constrain/plane'");
    }
    if (force->cg_active()) {
        complaints.add("coarsegraining", "charges and fields are those of real particles only. Remove it");
    }
    if (modify->n_fixes_style("multisphere") > 0) {
        complaints.add("multisphere", "only single spheres carry charge here. Remove 'fix multisphere'");
    }
    const FixChargeGranContact* charging = FixChargeGranContact::find(lmp);
    if (charging && modify->find_fix(charging->id) > modify->find_fix(id)) {
        complaints.add("order", "the field is computed from the charges at the end of a step, when all contacts have moved "
                                "theirs. Write this line below fix "
                                    + std::string(charging->id) + " charge/gran/contact");
    }
    if (charging && charging->atContactPoint()) {
        if (options_.wallContactField == WallContactField::self) {
            complaints.add("wall_contact_field",
                           "self leaves the field of the others out at walls, so 'wallField atContactPoint' of "
                           "fix charge/gran/contact has nothing to act on. Take one of them out");
        } else if (!FieldMethod::knowsPoints(options_.field.method)) {
            complaints.add("wallField", FieldMethod::noPointsText(options_.field.method));
        }
    }
    std::vector<DemWall> walls;
    for (const ListedWall& listed : listWalls(lmp)) {
        walls.push_back(listed.wall);
    }
    findImageWalls(options_, walls, complaints);
    const Box box{Vector3(domain->boxlo), Vector3(domain->boxhi)};
    const std::array<bool, 3> periodic{domain->xperiodic != 0, domain->yperiodic != 0, domain->zperiodic != 0};
    complaints.add(inWordsOfTheScript(FieldMethod::check(options_.field, nullptr, box, periodic)));
    if (!complaints.none()) {
        error->fix_error(FLERR, this, complaints.text().c_str());
    }
    options_.field.ownResponse = charging != nullptr;
    method_ = FieldMethod::create(options_.field, nullptr, box, periodic, world, times_);
    setPointField(method_->pointField());
}

void FixEfieldHim::init()
{
    checkScene();
    if (FixChargeGranContact* charging = FixChargeGranContact::find(lmp)) {
        charging->transfer().setPermittivity(options_.field.permittivity);
        charging->transfer().setPartnerCutoff(method_->partnerCutoff());
        charging->transfer().setWallContactField(options_.wallContactField);
    }
}

bool FixEfieldHim::needsUpdate() const
{
    bool mine = !valid_ && atom->nlocal > 0;
    if (!mine && update->ntimestep % options_.every == 0) {
        for (int i = 0; i < atom->nlocal && !mine; ++i) {
            mine = !std::equal(atom->x[i], atom->x[i] + 3, held_[i] + 3) || atom->q[i] != held_[i][6];
        }
    }
    int any = mine;
    MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
    return any != 0;
}

void FixEfieldHim::setup(int flag)
{
    ghostsExist_ = true;
    if (needsUpdate()) {
        computeField();
    }
    FixCoupleCfdEfield::post_force(flag);
}

void FixEfieldHim::post_force(int flag)
{
    // A field that is not held acts where it was computed. Computed at the end of the step it would act one step late, which
    // takes energy out of every approach and departure: a drift of first order in the time step.
    if (options_.every == 1) {
        computeField();
    }
    FixCoupleCfdEfield::post_force(flag);
}

void FixEfieldHim::end_of_step()
{
    if (options_.every > 1) {
        computeField();
    }
}

void FixEfieldHim::computeField()
{
    readRows(*atom, particles_);
    try {
        std::int64_t bad = countBadParticles(particles_);
        MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT64_T, MPI_SUM, world);
        if (bad > 0) {
            throwOnBadParticles(particles_, DemParticles(), world);
        }
        method_->compute(particles_, field_);
    } catch (const std::runtime_error& failure) {
        error->fix_error(FLERR, this, failure.what());
    }
    largestField_ = particles_.size() > 0 ? std::sqrt(field_.field.square().rowwise().sum().maxCoeff()) : 0;
    MPI_Allreduce(MPI_IN_PLACE, &largestField_, 1, MPI_DOUBLE, MPI_MAX, world);
    MPI_Allreduce(&field_.energy, &energy_, 1, MPI_DOUBLE, MPI_SUM, world);
    pairs_ = static_cast<double>(field_.pairs);
    setField(field_.field, field_.ownResponse);
    valid_ = true;
}

double FixEfieldHim::compute_vector(int n)
{
    if (n == 2) {
        return compute_limited();
    }
    return n == 0 ? largestField_ : pairs_;
}

void FixEfieldHim::write_restart(FILE* file)
{
    if (comm->me != 0) {
        return;
    }
    const double state[3] = {energy_, largestField_, pairs_};
    const int bytes = sizeof(state);
    std::fwrite(&bytes, sizeof(int), 1, file);
    std::fwrite(state, sizeof(state), 1, file);
}

void FixEfieldHim::restart(char* buffer)
{
    double state[3];
    std::memcpy(state, buffer, sizeof(state));
    energy_ = state[0];
    largestField_ = state[1];
    pairs_ = state[2];
}

int FixEfieldHim::size_restart(int)
{
    return 1 + width;
}

int FixEfieldHim::maxsize_restart()
{
    return 1 + width;
}

int FixEfieldHim::pack_restart(int row, double* buffer)
{
    buffer[0] = 1 + width;
    std::copy_n(held_[row], width, buffer + 1);
    return 1 + width;
}

void FixEfieldHim::unpack_restart(int row, int nth)
{
    // The extra values of all fixes stand one after the other, each with its length in front.
    const double* extra = atom->extra[row];
    int at = 0;
    for (int fix = 0; fix < nth; ++fix) {
        at += static_cast<int>(extra[at]);
    }
    std::copy_n(extra + at + 1, width, held_[row]);
    valid_ = true;
}

}  // namespace him
