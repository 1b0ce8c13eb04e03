// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/contact_recording.hpp"

#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "atom.h"
#include "error.h"
#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "force.h"

#include <algorithm>

namespace him {

using LIGGGHTS::ContactModels::SurfacesIntersectData;

ContactRecording::ContactRecording(LAMMPS_NS::LAMMPS* liggghts, LIGGGHTS::IContactHistorySetup* setup, bool wall)
    : Pointers(liggghts), wall_(wall)
{
    if (wall_) {
        wallFix_ = dynamic_cast<const LAMMPS_NS::FixWallGran*>(setup);
    } else {
        // Newton flag 0: neither changes sign when the two particles swap places. Charge moved counts towards the lower tag.
        history_ = setup->add_history_value("charging_area", "0");
        setup->add_history_value("charging_moved", "0");
    }
}

void ContactRecording::connect(const char* model)
{
    if (force->cg_active()) {
        error->cg(FLERR, model);
    }
    fix_ = FixChargeGranContact::find(lmp);
    if (!fix_) {
        error->all(FLERR,
                   "contact model 'cohesion charge' needs a 'fix <id> all charge/gran/contact ...' in the script");
    }
    fix_->refreshWalls();
    recorder_ = &fix_->recorder();
}

void ContactRecording::touching(SurfacesIntersectData& data)
{
    if (data.contact_flags) {
        *data.contact_flags |= LIGGGHTS::ContactModels::CONTACT_COHESION_MODEL;
    }
    if (!data.computeflag || !data.shearupdate) {
        return;
    }
    if (wall_) {
        recordWall(data);
    } else {
        recordPair(data);
    }
}

void ContactRecording::recordPair(const SurfacesIntersectData& data)
{
    double& reference = data.contact_history[history_];  // area of the last step, or the largest so far
    // contactArea() and effectiveRadius() without their checks: LIGGGHTS' radii and overlaps are positive here.
    const double area = recorder_->areaFactor * data.radi * data.radj / (data.radi + data.radj) * data.deltan;
    const double growth = area - reference;

    if (reference == 0 && (data.j < atom->nlocal || atom->tag[data.i] < atom->tag[data.j])) {
        ++recorder_->pairsBegun;  // a contact over a rank boundary is seen twice and counted by the lower tag
    }
    reference = recorder_->reloading == Reloading::counted ? area : std::max(reference, area);

    if (growth > 0 && fix_->contains(data.i) && fix_->contains(data.j)) {
        // LIGGGHTS' en points from j to i.
        recorder_->pairs.push_back({data.i,
                                    data.j,
                                    growth,
                                    {-data.en[0], -data.en[1], -data.en[2]},
                                    area,
                                    recorder_->keepsMoved ? &data.contact_history[history_ + 1] : nullptr});
    }
}

void ContactRecording::recordWall(const SurfacesIntersectData& data)
{
    if (!fix_->contains(data.i)) {
        return;
    }
    const LAMMPS_NS::Fix* wall = data.fix_mesh ? static_cast<const LAMMPS_NS::Fix*>(data.fix_mesh) : wallFix_;
    const double area = contactArea(recorder_->areaLaw, data.radi, data.deltan);
    // LIGGGHTS' en points from the wall to the particle.
    recorder_->touches.push_back({data.i, fix_->wallRow(wall), area, {-data.en[0], -data.en[1], -data.en[2]}});
}

}  // namespace him
