// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/contact_model_instances.hpp"

void him::registerHookeCharge()
{
    registerCombinations<models::HOOKE, models::COHESION_CHARGE>();
}
