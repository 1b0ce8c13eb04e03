// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/contact_model_instances.hpp"

void him::registerHookeChargeSjkr()
{
    registerCombinations<models::HOOKE, models::COHESION_CHARGE_SJKR>();
}
