// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/contact_models.hpp"

#include "dem_coupling/liggghts/contact_model_instances.hpp"

namespace him {

void registerContactModels()
{
    auto& models = LIGGGHTS::ContactModels::Factory::instance();
    models.addCohesionModel("charge", LIGGGHTS::ContactModels::COHESION_CHARGE);
    models.addCohesionModel("charge/sjkr", LIGGGHTS::ContactModels::COHESION_CHARGE_SJKR);
    registerHertzCharge();
    registerHertzChargeSjkr();
    registerHookeCharge();
    registerHookeChargeSjkr();
}

std::string knownContactModels()
{
    return "model hertz|hooke, tangential history|no_history, rolling_friction off|cdt|epsd2, cohesion "
           "charge|charge/sjkr";
}

}  // namespace him
