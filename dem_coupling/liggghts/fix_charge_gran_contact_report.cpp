// SPDX-License-Identifier: GPL-3.0-or-later
// What fix charge/gran/contact says and counts: texts, books, numbers for the script.
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "electrostatics/contact_area.hpp"

#include "atom.h"
#include "comm.h"
#include "fix_property_global.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <sstream>

namespace him {

std::string FixChargeGranContact::description()
{
    findSoftening();
    std::ostringstream text;
    text << transfer_.pairs().describe() << "    contact area " << nameOf(recorder_.areaLaw) << ", reloading "
         << (recorder_.reloading == Reloading::counted ? "counted" : "beyondMaximum") << ", curvature " << curvature_
         << " degrees, update " << nameOf(transfer_.update()) << ", own image at walls "
         << (transfer_.ownImage() ? "included" : "excluded") << '\n';
    if (transfer_.atContactPoint()) {
        text << "    field of the others at walls: at the contact point\n";
    }
    if (transfer_.pairs().acceleration() != 1) {
        text << "    ACCELERATED: every charge transfer is multiplied by a = " << transfer_.pairs().acceleration()
             << "; times of charging are not real times\n";
    }
    if (losses_.relaxationTime() > 0) {
        text << "    leakage to ground, relaxation time " << losses_.relaxationTime() << " s\n";
    }
    if (losses_.breakdownField() > 0) {
        text << "    breakdown above a surface field of " << losses_.breakdownField() << " V/m\n";
    }
    for (const WallRole& role : roles_) {
        if (!role.transfersCharge) {
            text << "    wall " << role.name << ": no charge transfer\n";
        }
    }
    text << initial_.describe() << timeStepWarning();
    return text.str();
}

std::string FixChargeGranContact::timeStepWarning() const
{
    // Measured by cases/singleContact: within 0.5 % of the law at 20 %, 1.3 % off at 30 % and 2.7 % at 40 %.
    constexpr double largestShare = 0.201;
    auto* young = dynamic_cast<LAMMPS_NS::FixPropertyGlobal*>(
        modify->find_fix_property("youngsModulus", "property/global", "peratomtype", atom->ntypes, 0, style));
    auto* poisson = dynamic_cast<LAMMPS_NS::FixPropertyGlobal*>(
        modify->find_fix_property("poissonsRatio", "property/global", "peratomtype", atom->ntypes, 0, style));
    double shortest = std::numeric_limits<double>::max();
    for (int i = 0; i < atom->nlocal; ++i) {
        const int type = atom->type[i] - 1;
        shortest = std::min(shortest, rayleighTimeStep(atom->radius[i], atom->density[i], young->compute_vector(type),
                                                       poisson->compute_vector(type)));
    }
    MPI_Allreduce(MPI_IN_PLACE, &shortest, 1, MPI_DOUBLE, MPI_MIN, world);
    if (update->dt <= largestShare * shortest) {
        return {};
    }
    std::ostringstream text;
    text.precision(3);
    text << "    WARNING: the time step, " << update->dt << " s, is " << 100 * update->dt / shortest
         << " % of the shortest Rayleigh step (R13) of the particles, " << shortest
         << " s. Above 20 % the largest overlap falls between two steps, and contacts move too little charge (1 to 3 % "
            "at 30 to 40 %). Use at most "
         << 0.2 * shortest << " s\n";
    return text.str();
}

void FixChargeGranContact::tell(const std::string& text) const
{
    if (comm->me != 0) {
        return;
    }
    for (FILE* file : {screen, logfile}) {
        if (file) {
            std::fputs(text.c_str(), file);
        }
    }
}

void FixChargeGranContact::post_run()
{
    if (hosted) {
        return;  // the host reports
    }
    const ContactCounts counts = contacts();
    std::ostringstream text;
    if (transfer_.pairs().acceleration() != 1) {
        text << "Contact charging was ACCELERATED by a = " << transfer_.pairs().acceleration() << '\n';
    }
    if (counts.strongFrozen > 0) {
        text << "WARNING: " << counts.strongFrozen
             << " contacts passed x = kappa A/(4 pi r^2) = 0.5 under 'update frozen', above which it may overshoot. "
                "Use 'update updated' or a smaller kappa\n";
    }
    if (losses_.breakdownField() > 0) {
        text << "Breakdown limited the charge of particles " << counts.breakdowns << " times\n";
    }
    tell(text.str());
}

ChargeMovements FixChargeGranContact::movements() const
{
    std::vector<double> mine{inserted_.value(), losses_.leaked().value(), losses_.brokenDown().value()};
    for (const CompensatedSum& given : transfer_.toWall()) {
        mine.push_back(given.value());
    }
    std::vector<double> all(mine.size());
    MPI_Allreduce(mine.data(), all.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_SUM, world);
    ChargeMovements total;
    total.inserted = all[0];
    total.leaked = all[1];
    total.breakdown = all[2];
    total.toWall.assign(all.begin() + 3, all.end());
    return total;
}

ContactCounts FixChargeGranContact::contacts() const
{
    const double mine[4] = {pairsBegun_, wallContactsBegun_, transfer_.strongFrozenContacts(), losses_.breakdowns()};
    double all[4];
    MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
    ContactCounts counts;
    counts.particleParticle = all[0];
    counts.particleWall = all[1];
    counts.strongFrozen = all[2];
    counts.breakdowns = all[3];
    double largest = transfer_.largestRelaxation();
    MPI_Allreduce(&largest, &counts.largestRelaxation, 1, MPI_DOUBLE, MPI_MAX, world);
    return counts;
}

double FixChargeGranContact::compute_vector(int n)
{
    const int walls = static_cast<int>(walls_.size());
    double mine = 0;
    if (n == 0) {
        mine = inserted_.value();
    } else if (n <= walls) {
        mine = transfer_.toWall()[static_cast<std::size_t>(n - 1)].value();
    } else {
        const double rest[4] = {losses_.leaked().value(), losses_.brokenDown().value(), losses_.breakdowns(),
                                transfer_.strongFrozenContacts()};
        mine = rest[n - 1 - walls];
    }
    double all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

}  // namespace him
