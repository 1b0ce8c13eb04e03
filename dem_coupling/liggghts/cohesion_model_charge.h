// SPDX-License-Identifier: GPL-3.0-or-later
// Contact model `charge` in LIGGGHTS' cohesion slot: no force, only a record of growing contacts.
#ifdef COHESION_MODEL
COHESION_MODEL(COHESION_CHARGE, charge, 40)
#else

#ifndef HIMFOAM_COHESION_MODEL_CHARGE_H
#define HIMFOAM_COHESION_MODEL_CHARGE_H

#include "dem_coupling/liggghts/contact_recording.hpp"

#include "cohesion_model_base.h"
#include "contact_models.h"

namespace LIGGGHTS {
namespace ContactModels {

template <> class CohesionModel<COHESION_CHARGE> : public CohesionModelBase {
public:
    CohesionModel(LAMMPS* lmp, IContactHistorySetup* setup, ContactModelBase* model)
        : CohesionModelBase(lmp, setup, model), recording_(lmp, setup, model->is_wall())
    {
    }

    void registerSettings(Settings&) override {}
    void postSettings(IContactHistorySetup*, ContactModelBase*) override {}
    void connectToProperties(PropertyRegistry&) override { recording_.connect("charge"); }

    void surfacesIntersect(SurfacesIntersectData& data, ForceData&, ForceData&) override { recording_.touching(data); }
    void surfacesClose(SurfacesCloseData& data, ForceData&, ForceData&) override { recording_.apart(data); }

    void endSurfacesIntersect(SurfacesIntersectData&, ForceData&, ForceData&) override {}
    void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
    void endPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}

private:
    him::ContactRecording recording_;
};

}  // namespace ContactModels
}  // namespace LIGGGHTS

#endif
#endif
