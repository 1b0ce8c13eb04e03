// SPDX-License-Identifier: GPL-3.0-or-later
// Contact model `charge/sjkr`: LIGGGHTS' SJKR cohesion together with the record of growing contacts.
#ifdef COHESION_MODEL
COHESION_MODEL(COHESION_CHARGE_SJKR, charge / sjkr, 41)
#else

#ifndef HIMFOAM_COHESION_MODEL_CHARGE_SJKR_H
#define HIMFOAM_COHESION_MODEL_CHARGE_SJKR_H

#include "dem_coupling/liggghts/contact_recording.hpp"

#include "cohesion_model_sjkr.h"

namespace LIGGGHTS {
namespace ContactModels {

template <> class CohesionModel<COHESION_CHARGE_SJKR> : public CohesionModel<COHESION_SJKR> {
    using Sjkr = CohesionModel<COHESION_SJKR>;

public:
    CohesionModel(LAMMPS* lmp, IContactHistorySetup* setup, ContactModelBase* model)
        : Sjkr(lmp, setup, model), recording_(lmp, setup, model->is_wall())
    {
    }

    void connectToProperties(PropertyRegistry& registry) override
    {
        Sjkr::connectToProperties(registry);
        recording_.connect("charge/sjkr");
    }
    void surfacesIntersect(SurfacesIntersectData& data, ForceData& forceI, ForceData& forceJ) override
    {
        Sjkr::surfacesIntersect(data, forceI, forceJ);
        recording_.touching(data);
    }
    void surfacesClose(SurfacesCloseData& data, ForceData& forceI, ForceData& forceJ) override
    {
        Sjkr::surfacesClose(data, forceI, forceJ);
        recording_.apart(data);
    }

private:
    him::ContactRecording recording_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS

#endif
#endif
