// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charge_losses.hpp"

#include "electrostatics/contact_charging.hpp"
#include "electrostatics/require.hpp"

#include <cmath>

namespace him {

void ChargeLosses::setRelaxationTime(double relaxationTime)
{
    requirePositive("relaxationTime [s]", relaxationTime);
    relaxationTime_ = relaxationTime;
}

void ChargeLosses::setBreakdownField(double field)
{
    requirePositive("breakdownField [V/m]", field);
    breakdownField_ = field;
}

double ChargeLosses::after(double charge, double radius, double timeStep, double permittivity)
{
    if (relaxationTime_ > 0) {
        const double kept = charge * std::exp(-timeStep / relaxationTime_);
        leaked_ += charge - kept;
        charge = kept;
    }
    if (breakdownField_ > 0) {
        const double largest = saturationCharge(breakdownField_, radius, permittivity);
        if (std::fabs(charge) > largest) {
            const double kept = std::copysign(largest, charge);
            brokenDown_ += charge - kept;
            breakdowns_ += 1;
            charge = kept;
        }
    }
    return charge;
}

}  // namespace him
