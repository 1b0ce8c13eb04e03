// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/contact_recorder.hpp"
#include "dem_coupling/liggghts/wall_list.hpp"

#include "atom.h"
#include "contact_interface.h"
#include "contact_model_constants.h"
#include "pointers.h"

#include <algorithm>

namespace him {

class FixChargeGranContact;

/// The recording half of a charging contact model: writes growing contacts into the recorder of fix charge/gran/contact.
/// Records only in the pass that advances time (computeflag and shearupdate), never in set-up or for a compute.
class ContactRecording : protected LAMMPS_NS::Pointers {
public:
    ContactRecording(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall);

    /// Finds the charging fix; an error that names `model` when the script has none.
    void connect(const char* model);

    void touching(LIGGGHTS::ContactModels::SurfacesIntersectData& data)
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

    void apart(LIGGGHTS::ContactModels::SurfacesCloseData& data)
    {
        if (data.contact_flags) {
            *data.contact_flags &= ~LIGGGHTS::ContactModels::CONTACT_COHESION_MODEL;
        }
        if (!wall_ && data.contact_history) {
            data.contact_history[history_] = 0;
            if (recorder_->movedValue >= 0) {
                data.contact_history[recorder_->movedValue] = 0;
            }
        }
    }

private:
    /// Inline, because LIGGGHTS' loop over pairs comes here for every contact in every step.
    void recordPair(const LIGGGHTS::ContactModels::SurfacesIntersectData& data)
    {
        double& reference = data.contact_history[history_];  // area of the last step, or the largest so far
        // contactArea() and effectiveRadius() without their checks: LIGGGHTS' radii and overlaps are positive here.
        const double area = recorder_->areaFactor * data.radi * data.radj / (data.radi + data.radj) * data.deltan;
        const double growth = area - reference;

        if (reference == 0 && (data.j < atom->nlocal || atom->tag[data.i] < atom->tag[data.j])) {
            ++recorder_->pairsBegun;  // a contact over a rank boundary is seen twice and counted by the lower tag
        }
        reference = recorder_->reloading == Reloading::counted ? area : std::max(reference, area);

        if (growth > 0 && (atom->mask[data.i] & atom->mask[data.j] & recorder_->groupBit)) {
            // LIGGGHTS' en points from j to i.
            recorder_->pairs.add({data.i,
                                  data.j,
                                  growth,
                                  {-data.en[0], -data.en[1], -data.en[2]},
                                  area,
                                  recorder_->movedValue >= 0 ? &data.contact_history[recorder_->movedValue] : nullptr});
        }
    }
    void recordWall(const LIGGGHTS::ContactModels::SurfacesIntersectData& data);

    bool wall_;
    const LAMMPS_NS::Fix* wallFix_ = nullptr;  ///< the wall fix that owns this model; null for pairs
    int history_ = -1;                         ///< reference area [m2] among the values of a pair contact
    FixChargeGranContact* fix_ = nullptr;
    ContactRecorder* recorder_ = nullptr;
};

}  // namespace him
