// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"
#include "electrostatics/constants.hpp"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
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

}  // namespace

bool FixChargeGranContact::hosted = false;

FixChargeGranContact* FixChargeGranContact::find(LAMMPS_NS::LAMMPS* lmp)
{
    return static_cast<FixChargeGranContact*>(lmp->modify->find_fix_style("charge/gran/contact", 0));
}

// ---------------------------------------------------------------------- script

FixChargeGranContact::Options FixChargeGranContact::readOptions(int narg, char** arg)
{
    Options options{ChargingPairs(atom->ntypes)};
    int next = 3;
    const auto word = [&](const std::string& after) -> std::string {
        if (next >= narg) {
            throw std::invalid_argument("something is missing after '" + after + "'");
        }
        return arg[next++];
    };
    const auto expect = [&](const char* keyword, const std::string& after) {
        const std::string found = word(after);
        if (found != keyword) {
            throw std::invalid_argument("expected '" + std::string(keyword) + "' after '" + after + "', found '" + found
                                        + "'");
        }
    };
    const auto number = [&](const std::string& after) {
        return force->numeric(FLERR, const_cast<char*>(word(after).c_str()));
    };
    const auto type = [&](const std::string& after) {
        return force->inumeric(FLERR, const_cast<char*>(word(after).c_str()));
    };

    while (next < narg) {
        const std::string keyword = word("");
        if (keyword == "pair") {
            const int first = type("pair");
            const int second = type("pair");
            const std::string what = word("pair I J");
            if (what == "none") {
                options.pairs.setNone(first, second);
            } else if (what == "gamma") {
                const double gamma = number("gamma");
                expect("kappa", "gamma <V/m>");
                options.pairs.set(first, second, gamma, number("kappa"));
            } else {
                throw std::invalid_argument("after 'pair I J' comes 'gamma <V/m> kappa <->' or 'none', found '" + what
                                            + "'");
            }
        } else if (keyword == "area") {
            options.area = areaLawByName(word("area"));
        } else if (keyword == "reloading") {
            const std::string name = word("reloading");
            if (name != "counted" && name != "beyondMaximum") {
                throw std::invalid_argument("unknown reloading '" + name + "'; known: counted, beyondMaximum");
            }
            options.reloading = name == "counted" ? Reloading::counted : Reloading::beyondMaximum;
        } else if (keyword == "curvature") {
            options.curvature = number("curvature");
        } else {
            throw std::invalid_argument("unknown keyword '" + keyword + "'; known: pair, area, reloading, curvature");
        }
    }
    return options;
}

FixChargeGranContact::FixChargeGranContact(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg)
    : Fix(liggghts, narg, arg), transfer_(ChargingPairs(1), epsilon0), wallMemory_(10), enabled_(!hosted)
{
    if (find(lmp)) {
        error->fix_error(FLERR, this, "there is already a fix charge/gran/contact; one holds all pairs");
    }
    if (!atom->q_flag || !atom->radius_flag) {
        error->fix_error(FLERR, this, "needs charged spheres: write 'atom_style hybrid granular charge'");
    }
    if (domain->dimension != 3) {
        error->fix_error(FLERR, this,
                         "found 'dimension 2', which makes discs of unit length; contact areas are those of spheres. Write "
                         "'dimension 3', and confine spheres to a plane by fix constrain/plane");
    }
    if (strcmp(update->unit_style, "si") != 0) {
        error->fix_error(FLERR, this, "works in 'units si' only");
    }
    try {
        Options options = readOptions(narg, arg);
        recorder_.areaLaw = options.area;
        recorder_.reloading = options.reloading;
        curvature_ = options.curvature;
        wallMemory_ = WallContactMemory(options.curvature);
        transfer_ = ChargeTransfer(std::move(options.pairs), epsilon0);
    } catch (const std::invalid_argument& wrong) {
        error->fix_error(FLERR, this, wrong.what());
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
    return LAMMPS_NS::FixConst::END_OF_STEP;
}

void FixChargeGranContact::init()
{
    field_ = FixCoupleCfdEfield::find(lmp);
    refreshWalls();
    const bool periodic = domain->xperiodic || domain->yperiodic || domain->zperiodic;
    transfer_.setMinimumImage(periodic ? shortenInBox : nullptr, domain);
}

// ---------------------------------------------------------------------- walls

bool FixChargeGranContact::contains(int row) const
{
    return atom->mask[row] & groupbit;
}

int FixChargeGranContact::wallRow(const LAMMPS_NS::Fix* wall) const
{
    for (std::size_t row = 0; row < walls_.size(); ++row) {
        if (walls_[row].fix == wall) {
            return static_cast<int>(row);
        }
    }
    error->one(FLERR, "a wall touches particles that fix charge/gran/contact does not know");
    return -1;
}

void FixChargeGranContact::refreshWalls()
{
    std::vector<ListedWall> now = listWalls(lmp);
    std::vector<CompensatedSum> given(now.size());
    std::vector<int> types;
    std::vector<char> transfers;
    for (std::size_t row = 0; row < now.size(); ++row) {
        const DemWall& wall = now[row].wall;
        types.push_back(wall.type);
        const auto role =
            std::find_if(roles_.begin(), roles_.end(), [&](const WallRole& r) { return r.name == wall.name; });
        transfers.push_back(role == roles_.end() || role->transfersCharge);
        for (std::size_t old = 0; old < walls_.size(); ++old) {
            if (walls_[old].wall.name == wall.name) {
                given[row] = transfer_.toWall()[old];
            }
        }
    }
    if (!restartedToWall_.empty() && restartedToWall_.size() == now.size()) {
        std::transform(restartedToWall_.begin(), restartedToWall_.end(), given.begin(),
                       [](double charge) { return CompensatedSum(charge); });
        restartedToWall_.clear();
    }
    walls_ = std::move(now);
    transfer_.setWalls(std::move(types), std::move(transfers));
    transfer_.toWall() = std::move(given);
    size_vector = 1 + static_cast<int>(walls_.size());
}

void FixChargeGranContact::setWallRoles(const std::vector<WallRole>& roles)
{
    roles_ = roles;
    refreshWalls();
}

void FixChargeGranContact::handOver()
{
    enabled_ = true;
    std::fill(booked_.begin(), booked_.begin() + atom->nlocal, char(1));
    arrivals_ = false;
}

std::string FixChargeGranContact::description() const
{
    std::ostringstream text;
    text << transfer_.pairs().describe() << "    contact area " << nameOf(recorder_.areaLaw) << ", reloading "
         << (recorder_.reloading == Reloading::counted ? "counted" : "beyondMaximum") << ", curvature " << curvature_
         << " degrees\n";
    return text.str();
}

// ---------------------------------------------------------------------- the step

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
            bookArrivals();
        }
        DemRows rows;
        rows.local = atom->nlocal;
        rows.all = atom->nlocal + atom->nghost;
        rows.tag = atom->tag;
        rows.type = atom->type;
        rows.radius = atom->radius;
        rows.charge = atom->q;
        rows.held.rows = field_ ? field_->held() : nullptr;

        transfer_.sumRelaxations(rows, recorder_.pairs, growingWallContacts_);
        const bool ghosts = comm->nprocs > 1 || domain->xperiodic || domain->yperiodic || domain->zperiodic;
        if (ghosts) {
            comm->forward_comm_fix(this);
        }
        transfer_.move(rows, recorder_.pairs, growingWallContacts_);
    }
    recorder_.clear();
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

// ---------------------------------------------------------------------- books

ChargeMovements FixChargeGranContact::movements() const
{
    std::vector<double> mine{inserted_.value()};
    for (const CompensatedSum& given : transfer_.toWall()) {
        mine.push_back(given.value());
    }
    std::vector<double> all(mine.size());
    MPI_Allreduce(mine.data(), all.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_SUM, world);
    ChargeMovements total;
    total.inserted = all[0];
    total.toWall.assign(all.begin() + 1, all.end());
    return total;
}

ContactCounts FixChargeGranContact::contacts() const
{
    double mine[2] = {pairsBegun_, wallContactsBegun_};
    double all[2];
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
    ContactCounts counts;
    counts.particleParticle = all[0];
    counts.particleWall = all[1];
    double largest = transfer_.largestRelaxation();
    MPI_Allreduce(&largest, &counts.largestRelaxation, 1, MPI_DOUBLE, MPI_MAX, world);
    return counts;
}

double FixChargeGranContact::compute_vector(int n)
{
    const double mine = n == 0 ? inserted_.value() : transfer_.toWall().at(n - 1).value();
    double all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

}  // namespace him
