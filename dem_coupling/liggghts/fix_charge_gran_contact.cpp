// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "dem_coupling/liggghts/charge_gran_contact_options.hpp"
#include "dem_coupling/liggghts/find_fix.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/parameters/impact_area.hpp"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_contact_history.h"
#include "fix_property_global.h"
#include "force.h"
#include "modify.h"
#include "pair_gran.h"
#include "update.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

/// LIGGGHTS' minimum image of a vector [m] between two positions, in place.
void shortenInBox(void* box, double* vector)
{
    static_cast<LAMMPS_NS::Domain*>(box)->minimum_image(vector[0], vector[1], vector[2]);
}

/// The granular pair style of this LIGGGHTS instance, or null.
LAMMPS_NS::PairGran* granularPair(LAMMPS_NS::LAMMPS* lmp)
{
    return dynamic_cast<LAMMPS_NS::PairGran*>(lmp->force->pair_match("gran", 0));
}

/// Whether the contacts of this script have room for a value that no fix asks for: an earlier charging fix had asked for it, and
/// LIGGGHTS keeps the room that it made at the first `run`.
bool hasSpareHistory(LAMMPS_NS::LAMMPS* lmp)
{
    LAMMPS_NS::PairGran* pair = granularPair(lmp);
    if (!pair || !pair->get_fix_history()) {
        return false;
    }
    int asked = pair->dnum_pair();
    for (int i = 0; i < lmp->modify->nfix; ++i) {
        asked += lmp->modify->fix[i] ? lmp->modify->fix[i]->n_history_extra() : 0;
    }
    return pair->get_fix_history()->get_dnum() > asked;
}

}  // namespace

bool FixChargeGranContact::hosted = false;

FixChargeGranContact* FixChargeGranContact::find(LAMMPS_NS::LAMMPS* lmp)
{
    return findFix<FixChargeGranContact>(lmp);
}

// ---------------------------------------------------------------------- script

FixChargeGranContact::FixChargeGranContact(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg)
    : Fix(liggghts, narg, arg), transfer_(ChargingPairs(1), epsilon0), wallMemory_(10), enabled_(!hosted), initial_(1)
{
    if (find(lmp)) {
        error->fix_error(FLERR, this, "there is already a fix charge/gran/contact; one holds all pairs");
    }
    if (!atom->q_flag || !atom->radius_flag) {
        error->fix_error(FLERR, this, "needs charged spheres: write 'atom_style hybrid granular charge'");
    }
    if (domain->dimension != 3) {
        error->fix_error(
            FLERR, this,
            "found 'dimension 2', which makes discs of unit length; contact areas are those of spheres. Write "
            "'dimension 3', and confine spheres to a plane by fix constrain/plane");
    }
    if (strcmp(update->unit_style, "si") != 0) {
        error->fix_error(FLERR, this, "works in 'units si' only");
    }
    try {
        ChargeGranContactOptions options =
            readChargeGranContactOptions(std::vector<std::string>(arg + 3, arg + narg), atom->ntypes);
        recorder_.areaLaw = options.area;
        recorder_.areaFactor = contactArea(options.area, 1, 1);
        recorder_.reloading = options.reloading;
        curvature_ = options.curvature;
        wallMemory_ = WallContactMemory(options.curvature);
        transfer_ = ChargeTransfer(std::move(options.pairs), epsilon0);
        transfer_.setUpdate(options.update);
        transfer_.setOwnImage(options.ownImage);
        transfer_.setAtContactPoint(options.atContactPoint);
        recorder_.groupBit = groupbit;
        recorder_.pairs.keep(true, options.update == WithinContact::frozen);
        losses_ = options.losses;
        initial_ = options.initial;
        realModuli_ = options.realModuli;
        roles_ = options.walls;
    } catch (const std::invalid_argument& wrong) {
        error->fix_error(FLERR, this, wrong.what());
    }
    roomInHistory_ = hasSpareHistory(lmp);
    const LAMMPS_NS::PairGran* pair = granularPair(lmp);
    if (recorder_.pairs.keepsWithin() && pair && pair->get_fix_history() && !roomInHistory_) {
        error->fix_error(
            FLERR, this,
            "'update frozen' keeps a value in every contact, for which LIGGGHTS makes room at the first 'run'. "
            "Write this fix before it");
    }
    nevery = 1;
    create_attribute = 1;
    just_created = 0;  // otherwise the first set-up would call set_arrays for particles that are already there
    comm_forward = 2;
    restart_peratom = 1;
    restart_global = 1;
    vector_flag = 1;
    extvector = 1;
    global_freq = 1;
    grow_arrays(atom->nmax);
    atom->add_callback(0);
    atom->add_callback(1);
    refreshWalls();
    // Particles that exist already carry the opening charge.
    std::fill(booked_.begin(), booked_.end(), char(1));
}

FixChargeGranContact::~FixChargeGranContact()
{
    atom->delete_callback(id, 0);
    atom->delete_callback(id, 1);
}

int FixChargeGranContact::setmask()
{
    return LAMMPS_NS::FixConst::PRE_EXCHANGE | LAMMPS_NS::FixConst::END_OF_STEP;
}

void FixChargeGranContact::init()
{
    field_ = FixCoupleCfdEfield::find(lmp);
    recorder_.pairs.keep(field_, recorder_.pairs.keepsWithin());
    refreshWalls();
    tellOfLostWalls();
    for (const WallRole& role : roles_) {
        if (std::none_of(walls_.begin(), walls_.end(), [&](const ListedWall& w) { return w.wall.name == role.name; })) {
            error->fix_error(FLERR, this, ("wall " + role.name + ": the script has no such wall").c_str());
        }
    }
    if (!hosted) {
        checkPairs();
    }
    prepare();
    if (!hosted && !told_) {
        tell("Contact charging, fix " + std::string(id) + ":\n" + description());
        told_ = true;
    }
    const bool periodic = domain->xperiodic || domain->yperiodic || domain->zperiodic;
    transfer_.setMinimumImage(periodic ? shortenInBox : nullptr, domain);
}

int FixChargeGranContact::n_history_extra()
{
    LAMMPS_NS::PairGran* pair = granularPair(lmp);
    return (recorder_.pairs.keepsWithin() || roomInHistory_) && pair && pair->is_history() ? 1 : 0;
}

bool FixChargeGranContact::history_args(char** args)
{
    static char name[] = "charging_moved";
    static char keepsSign[] = "0";  // when the two particles swap places
    args[0] = name;
    args[1] = keepsSign;
    return true;
}

void FixChargeGranContact::placeHistory()
{
    recorder_.movedValue = n_history_extra() > 0 ? granularPair(lmp)->fix_extra_dnum_index(this) : -1;
}

void FixChargeGranContact::handOver()
{
    enabled_ = true;
    std::fill(booked_.begin(), booked_.begin() + atom->nlocal, char(1));
    arrivals_ = false;
}

void FixChargeGranContact::findSoftening()
{
    if (realModuli_.empty()) {
        return;
    }
    const int types = atom->ntypes;
    auto* young = dynamic_cast<LAMMPS_NS::FixPropertyGlobal*>(
        modify->find_fix_property("youngsModulus", "property/global", "peratomtype", types, 0, style));
    auto* poisson = dynamic_cast<LAMMPS_NS::FixPropertyGlobal*>(
        modify->find_fix_property("poissonsRatio", "property/global", "peratomtype", types, 0, style));
    const auto real = [&](int type) {
        const auto given = realModuli_.find(type);
        return Elasticity{given == realModuli_.end() ? young->compute_vector(type - 1) : given->second,
                          poisson->compute_vector(type - 1)};
    };
    const auto soft = [&](int type) {
        return Elasticity{young->compute_vector(type - 1), poisson->compute_vector(type - 1)};
    };
    for (const auto& [type, modulus] : realModuli_) {
        if (modulus < soft(type).youngsModulus) {
            error->fix_error(FLERR, this,
                             ("realModulus " + std::to_string(type)
                              + ": the real modulus is below the script's youngsModulus, which is meant to be the "
                                "softened one")
                                 .c_str());
        }
        for (int other = 1; other <= types; ++other) {
            transfer_.pairs().setSoftening(type, other,
                                           softeningCorrection(effectiveModulus(soft(type), soft(other)),
                                                               effectiveModulus(real(type), real(other))));
        }
    }
    transfer_.setPermittivity(transfer_.permittivity());
}

// ---------------------------------------------------------------------- the step

void FixChargeGranContact::prepare()
{
    findSoftening();
    chargeNewParticles();
    if (enabled_) {
        bookArrivals();
    }
}

void FixChargeGranContact::chargeNewParticles()
{
    if (!initial_.any()) {
        return;
    }
    for (int i = 0; i < atom->nlocal; ++i) {
        if (charged_[i]) {
            continue;
        }
        charged_[i] = 1;
        if (atom->q[i] == 0 && contains(i)) {
            atom->q[i] =
                initial_.of(atom->type[i], atom->tag[i], atom->radius[i], transfer_.pairs(), transfer_.permittivity());
            if (booked_[i]) {
                inserted_ += atom->q[i];  // it was there without charge when the books were opened
            }
        }
    }
}

void FixChargeGranContact::loseCharge()
{
    for (int i = 0; i < atom->nlocal; ++i) {
        if (contains(i)) {
            atom->q[i] = losses_.after(atom->q[i], atom->radius[i], update->dt, transfer_.permittivity());
        }
    }
}

void FixChargeGranContact::bookArrivals()
{
    for (int i = 0; i < atom->nlocal; ++i) {
        if (!booked_[i]) {
            inserted_ += atom->q[i];
            booked_[i] = 1;
        }
    }
    arrivals_ = false;
}

void FixChargeGranContact::end_of_step()
{
    wallContactsBegun_ += static_cast<double>(
        wallMemory_.update(recorder_.touches, atom->nlocal, recorder_.reloading, growingWallContacts_));
    pairsBegun_ += static_cast<double>(recorder_.pairsBegun);
    if (enabled_) {
        if (arrivals_) {
            chargeNewParticles();
            bookArrivals();
        }
    }
    if (enabled_ && !stopped_) {
        if (transfer_.pairs().transfers()) {
            moveCharges();
        }
        if (losses_.active()) {
            loseCharge();
        }
    }
    recorder_.clear();
}

void FixChargeGranContact::moveCharges()
{
    DemRows rows;
    rows.local = atom->nlocal;
    rows.all = atom->nlocal + atom->nghost;
    rows.tag = atom->tag;
    rows.type = atom->type;
    rows.radius = atom->radius;
    rows.charge = atom->q;
    rows.held = field_ ? field_->held() : HeldField();

    transfer_.sumRelaxations(rows, recorder_.pairs, growingWallContacts_);
    const bool ghosts = comm->nprocs > 1 || domain->xperiodic || domain->yperiodic || domain->zperiodic;
    if (ghosts) {
        comm->forward_comm_fix(this);
    }
    if (transfer_.atContactPoint() && field_) {
        findFieldAtContactPoints();
    }
    transfer_.move(rows, recorder_.pairs, growingWallContacts_);
    wallCharges_.add(transfer_.wallGains(), atom->x, atom->radius);
}

int FixChargeGranContact::pack_comm(int n, int* list, double* buffer, int, int*)
{
    const std::vector<double>& sums = transfer_.relaxationSums();
    for (int k = 0; k < n; ++k) {
        buffer[2 * k] = atom->q[list[k]];
        buffer[2 * k + 1] = sums[list[k]];
    }
    return comm_forward;
}

void FixChargeGranContact::unpack_comm(int n, int first, double* buffer)
{
    std::vector<double>& sums = transfer_.relaxationSums();
    for (int k = 0; k < n; ++k) {
        atom->q[first + k] = buffer[2 * k];
        sums[first + k] = buffer[2 * k + 1];
    }
}

}  // namespace him
