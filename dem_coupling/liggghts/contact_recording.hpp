// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/contact_recorder.hpp"
#include "dem_coupling/liggghts/wall_list.hpp"

#include "contact_interface.h"
#include "contact_model_constants.h"
#include "pointers.h"

namespace him {

class FixChargeGranContact;

/// The recording half of a charging contact model: writes growing contacts into the recorder of fix charge/gran/contact.
/// Records only in the pass that advances time (computeflag and shearupdate), never in set-up or for a compute.
class ContactRecording : protected LAMMPS_NS::Pointers {
public:
    ContactRecording(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall);

    /// Finds the charging fix; an error that names `model` when the script has none.
    void connect(const char* model);

    void touching(LIGGGHTS::ContactModels::SurfacesIntersectData& data);

    void apart(LIGGGHTS::ContactModels::SurfacesCloseData& data)
    {
        if (data.contact_flags) {
            *data.contact_flags &= ~LIGGGHTS::ContactModels::CONTACT_COHESION_MODEL;
        }
        if (!wall_ && data.contact_history) {
            data.contact_history[history_] = 0;
            data.contact_history[history_ + 1] = 0;
        }
    }

private:
    void recordPair(const LIGGGHTS::ContactModels::SurfacesIntersectData& data);
    void recordWall(const LIGGGHTS::ContactModels::SurfacesIntersectData& data);

    bool wall_;
    const LAMMPS_NS::Fix* wallFix_ = nullptr;  ///< the wall fix that owns this model; null for pairs
    int history_ = -1;                         ///< first of two values per pair contact: reference area [m2], charge moved [C]
    FixChargeGranContact* fix_ = nullptr;
    ContactRecorder* recorder_ = nullptr;
};

}  // namespace him
