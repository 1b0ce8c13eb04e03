// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/contact_recording.hpp"

#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "error.h"
#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "force.h"

namespace him {

using LIGGGHTS::ContactModels::SurfacesIntersectData;

ContactRecording::ContactRecording(LAMMPS_NS::LAMMPS* liggghts, LIGGGHTS::IContactHistorySetup* setup, bool wall)
    : Pointers(liggghts), wall_(wall)
{
    if (wall_) {
        wallFix_ = dynamic_cast<const LAMMPS_NS::FixWallGran*>(setup);
    } else {
        // Newton flag 0: it does not change sign when the two particles swap places.
        history_ = setup->add_history_value("charging_area", "0");
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
    fix_->placeHistory();
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
