// SPDX-License-Identifier: GPL-3.0-or-later
// What of a script LiggghtsDem can not simulate.
#include "dem_coupling/liggghts/liggghts_dem.hpp"

#include "dem_coupling/liggghts/contact_models.hpp"
#include "dem_coupling/liggghts/fix_efield_him.hpp"

#include "atom.h"
#include "domain.h"
#include "force.h"
#include "modify.h"
#include "pair_gran.h"
#include "update.h"

#include <cstring>

namespace him {

Complaints LiggghtsDem::check() const
{
    Complaints complaints;
    if (!lmp_->domain->box_exist) {
        complaints.add(script_,
                       "the script creates no simulation box. Use 'create_box', 'read_data' or 'read_restart'.");
        return complaints;
    }
    if (std::strcmp(lmp_->update->unit_style, "si") != 0) {
        complaints.add(script_, "units '" + std::string(lmp_->update->unit_style)
                                    + "' found; himFoam works in SI only. Write 'units si'.");
    }
    if (lmp_->domain->dimension != 3) {
        complaints.add(script_,
                       "'dimension 2' found, which makes discs of unit length with the mass and the contact area of "
                       "cylinders. Write 'dimension 3', and confine spheres to a plane by fix constrain/plane.");
    }
    if (!needsCharge_ && !lmp_->atom->radius_flag) {
        complaints.add(script_, "atom_style '" + std::string(lmp_->atom->atom_style)
                                    + "' found; spheres are needed. Write 'atom_style granular'.");
    } else if (needsCharge_ && (!lmp_->atom->q_flag || !lmp_->atom->radius_flag)) {
        complaints.add(script_,
                       "atom_style '" + std::string(lmp_->atom->atom_style)
                           + "' found; charged spheres are needed. Write 'atom_style hybrid granular charge'.");
    }
    if (lmp_->force->cg_active()) {
        complaints.add(script_,
                       "coarse graining is on; the charging law is for real particles only. Remove 'coarsegraining'.");
    }
    if (lmp_->modify->n_fixes_style("multisphere") > 0) {
        complaints.add(script_,
                       "multisphere particles found; only single spheres carry charge here. Remove 'fix multisphere'.");
    }
    if (lmp_->atom->superquadric_flag) {
        complaints.add(
            script_,
            "superquadric particles found; only spheres carry charge here. Use 'atom_style hybrid granular charge'.");
    }
    if (drag_) {
        for (const char* style : {"freeze", "setforce"}) {
            if (lmp_->modify->n_fixes_style(style) > 0) {
                complaints.add(
                    script_, "fix " + std::string(style)
                                 + " found; the gas acts after it, so it would not hold its particles. Leave them out "
                                   "of the group of 'fix nve/sphere' instead.");
            }
        }
    }
    if (const auto* fix = dynamic_cast<FixEfieldHim*>(FixCoupleCfdEfield::find(lmp_.get()))) {
        complaints.add(script_,
                       "fix " + std::string(fix->id)
                           + " of style efield/him found, which computes the field in "
                             "liggghtsHim. Here fieldMethod in constant/electrostaticProperties does. Remove the fix.");
    }
    if (charging_ && !needsCharge_ && charging_->transfer().pairs().transfers()) {
        complaints.add(script_,
                       "fix " + std::string(charging_->id)
                           + " charges particles, but the case has no constant/electrostaticProperties. Write that "
                             "file, remove the fix, or write 'none' for all of its pairs.");
    }
    if (charging_) {
        checkContactModels(complaints);
        charging_->complainAboutMissingPairs(script_ + ": fix " + charging_->id, true, complaints);
    }
    return complaints;
}

void LiggghtsDem::checkContactModels(Complaints& complaints) const
{
    auto* pair = dynamic_cast<LAMMPS_NS::PairGran*>(lmp_->force->pair);
    if (!pair || !(pair->contact_match("cohesion", "charge") || pair->contact_match("cohesion", "charge/sjkr"))) {
        complaints.add(
            script_,
            "fix charge/gran/contact is there, but pair_style does not record contacts. Add 'cohesion charge' (or "
            "'cohesion charge/sjkr') to pair_style gran. Known: "
                + knownContactModels() + ".");
    }
}

}  // namespace him
