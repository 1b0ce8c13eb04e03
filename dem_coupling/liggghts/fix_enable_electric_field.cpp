// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_enable_electric_field.hpp"

#include "dem_coupling/liggghts/find_fix.hpp"
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_property_global.h"
#include "group.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <set>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

constexpr const char* knownKeywords = "field_cutoff_radius, id, particle_group, use_without_cfd_coupling, "
                                      "enable_collision_charge_transfer, charge_transfer_cutoff, "
                                      "limit_field_force, field_force_limit_factor";

std::string exact(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.17g", value);
    return text;
}

}  // namespace

EnableElectricFieldOptions readEnableElectricFieldOptions(const std::vector<std::string>& words)
{
    EnableElectricFieldOptions options;
    Complaints complaints;
    WordReader reader(words, complaints);
    std::set<std::string> given;
    while (!reader.done()) {
        const std::string keyword = reader.word("");
        if (!given.insert(keyword).second) {
            complaints.add(keyword, "given twice");
        }
        if (keyword == "field_cutoff_radius") {
            options.cutoff = reader.positive(keyword, "[m]");
        } else if (keyword == "id") {
            options.name = reader.word(keyword);
        } else if (keyword == "particle_group") {
            options.group = reader.word(keyword);
        } else if (keyword == "use_without_cfd_coupling") {
            options.withoutCoupling = reader.oneOf(keyword, {"no", "yes"}) == 1;
        } else if (keyword == "enable_collision_charge_transfer") {
            options.charging = reader.oneOf(keyword, {"no", "yes"}) == 1;
        } else if (keyword == "charge_transfer_cutoff") {
            options.separation = reader.positive(keyword, "[m]");
        } else if (!readLimiter(keyword, reader, options.limiter, complaints)) {
            throw std::invalid_argument("unknown keyword '" + keyword + "'; known: " + knownKeywords);
        }
    }
    if (!given.count("field_cutoff_radius")) {
        complaints.add("field_cutoff_radius",
                       "it is obligatory: the distance [m] up to which the near field is computed from the particles");
    }
    if (given.count("charge_transfer_cutoff") && !options.charging) {
        complaints.add("charge_transfer_cutoff", "it says nothing without 'enable_collision_charge_transfer yes'");
    }
    if (!complaints.none()) {
        throw std::invalid_argument(complaints.text());
    }
    return options;
}

FixEnableElectricField* FixEnableElectricField::find(LAMMPS_NS::LAMMPS* lmp)
{
    return findFix<FixEnableElectricField>(lmp);
}

FixEnableElectricField::FixEnableElectricField(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg)
    : Fix(liggghts, narg, arg)
{
    if (find(lmp)) {
        error->fix_error(FLERR, this, "there can only be one enable_electric_field in the whole simulation");
    }
    if (std::strcmp(update->unit_style, "si") != 0) {
        error->fix_error(FLERR, this, "works in 'units si' only");
    }
    if (!atom->q_flag) {
        error->fix_error(
            FLERR, this,
            "needs charged spheres ('charged yes' on its page): write 'atom_style hybrid granular charge'");
    }
    try {
        options_ = readEnableElectricFieldOptions(std::vector<std::string>(arg + 3, arg + narg));
    } catch (const std::invalid_argument& wrong) {
        error->fix_error(FLERR, this, wrong.what());
    }
    name_ = options_.name.empty() ? std::string(id) : options_.name;
    group_ = options_.group.empty() ? std::string(group->names[igroup]) : options_.group;
    if (group->find(group_.c_str()) < 0) {
        error->fix_error(FLERR, this, ("particle_group: there is no group '" + group_ + "'").c_str());
    }
    if (!options_.withoutCoupling && !FixChargeGranContact::hosted) {
        error->fix_error(FLERR, this,
                         "'use_without_cfd_coupling no' demands the field of a mesh. Run the script with himFoam, or "
                         "write 'use_without_cfd_coupling yes' "
                         "for the near field alone");
    }
}

std::string FixEnableElectricField::description() const
{
    std::ostringstream text;
    text << "enable_electric_field " << name_ << ": ";
    if (FixChargeGranContact::hosted) {
        text << "the case's field method gives the field; with him its nearCutoff has to be field_cutoff_radius, "
             << options_.cutoff << " m\n";
    } else {
        text << "near field of pairs up to " << options_.cutoff
             << " m alone, without a mesh (himFoam has the far field)\n";
    }
    if (options_.charging) {
        text << "    Charge transfer by work functions, Gamma_ij = (phi_j - phi_i)/(delta e), delta = "
             << options_.separation
             << " m.\n    The sign of (phi_i - phi_j) on the command's page is reversed: here, as in nature, the body "
                "of the higher work\n"
                "    function charges negatively. Give the page's numbers as they are. kappa 1, contact area hertz; "
                "mesh walls are\n"
                "    grounded conductors, primitive walls take no charge.\n";
    }
    if (options_.limiter.active) {
        text << "    Forces of the field are limited to " << options_.limiter.factor << " m skin/dt^2.\n";
    }
    return text.str();
}

void FixEnableElectricField::post_create()
{
    if (comm->me == 0) {
        const std::string text = description();
        for (FILE* file : {screen, logfile}) {
            if (file) {
                std::fputs(text.c_str(), file);
            }
        }
    }
    if (options_.charging) {
        makeCharging();
    }
    makeField();
}

void FixEnableElectricField::add(const std::vector<std::string>& words)
{
    std::vector<std::string> copy = words;
    std::vector<char*> arguments;
    for (std::string& word : copy) {
        arguments.push_back(word.data());
    }
    modify->add_fix(static_cast<int>(arguments.size()), arguments.data());
    made_.push_back(words.front());
}

void FixEnableElectricField::makeCharging()
{
    if (FixChargeGranContact::find(lmp)) {
        error->fix_error(
            FLERR, this,
            "there is already a fix charge/gran/contact. Remove it, or write 'enable_collision_charge_transfer no'");
    }
    auto* property = dynamic_cast<LAMMPS_NS::FixPropertyGlobal*>(
        modify->find_fix_property("workFunction", "property/global", "peratomtype", atom->ntypes, 0, style, false));
    if (!property) {
        error->fix_error(FLERR, this,
                         "charge transfer needs the work function of every type: write 'fix <id> all property/global "
                         "workFunction peratomtype <J> <J> ...' "
                         "above this line");
    }
    const std::string charging = std::string(id) + "Charging";
    std::vector<std::string> words{charging, group_, "charge/gran/contact", "deltaE", exact(options_.separation)};
    for (int type = 1; type <= atom->ntypes; ++type) {
        words.insert(words.end(), {"workFunction", std::to_string(type), exact(property->compute_vector(type - 1))});
        for (int other = type; other <= atom->ntypes; ++other) {
            words.insert(words.end(),
                         {"pair", std::to_string(type), std::to_string(other), "workFunctions", "kappa", "1"});
        }
    }
    add(words);
}

void FixEnableElectricField::makeField()
{
    std::vector<std::string> words{std::string(id) + "Field", group_};
    if (FixChargeGranContact::hosted) {
        words.emplace_back("couple/cfd/efield");
    } else {
        words.insert(words.end(), {"efield/him", "method", "directTruncation", "cutoff", exact(options_.cutoff)});
    }
    if (options_.limiter.active) {
        words.insert(words.end(),
                     {"limit_field_force", "yes", "field_force_limit_factor", exact(options_.limiter.factor)});
    }
    add(words);
}

void FixEnableElectricField::init()
{
    FixChargeGranContact* charging = FixChargeGranContact::find(lmp);
    if (!options_.charging || !charging) {
        return;
    }
    charging->refreshWalls();
    std::vector<WallRole> primitive;
    for (const ListedWall& listed : charging->walls()) {
        if (listed.wall.primitive) {
            primitive.push_back({listed.wall.name, false});
        }
    }
    charging->setWallRoles(primitive);
}

void FixEnableElectricField::pre_delete(bool unfix)
{
    if (unfix) {
        for (const std::string& name : made_) {
            modify->delete_fix(name.c_str(), true);
        }
    }
}

}  // namespace him
