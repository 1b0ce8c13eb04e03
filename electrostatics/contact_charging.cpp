// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/contact_charging.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/require.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// The same as conductanceOf(), of checked factors.
double conductance(double efficiency, double areaGrowth, double permittivity)
{
    requirePositive("permittivity", permittivity);
    requireNotNegative("charging efficiency", efficiency);
    requireNotNegative("area growth", areaGrowth);
    return conductanceOf(efficiency, areaGrowth, permittivity);
}

/// Gamma less the field at the contact [V/m] (R16, R28). Every term changes sign with Gamma and the charges, so the sum
/// does so to the last bit.
double netDrive(const ContactDrive& drive)
{
    return drive.transferLimit - drive.surfaceFieldA + drive.surfaceFieldB - drive.fieldNormal;
}

}  // namespace

double surfaceField(double charge, double radius, double permittivity)
{
    requirePositive("radius", radius);
    requirePositive("permittivity", permittivity);
    return charge / (4.0 * pi * permittivity * radius * radius);
}

double saturationCharge(double transferLimit, double radius, double permittivity)
{
    requirePositive("radius", radius);
    requirePositive("permittivity", permittivity);
    return 4.0 * pi * permittivity * radius * radius * transferLimit;
}

double relaxationNumber(double efficiency, double areaGrowth, double radius)
{
    requireNotNegative("charging efficiency", efficiency);
    requireNotNegative("area growth", areaGrowth);
    requirePositive("radius", radius);
    return efficiency * areaGrowth / (4.0 * pi * radius * radius);
}

double relaxationFactor(double relaxation)
{
    requireNotNegative("relaxation", relaxation);
    return relaxationFactorOf(relaxation);
}

double chargeGained(const ContactDrive& drive, double relaxation, double efficiency, double areaGrowth,
                    double permittivity)
{
    if (std::islessequal(areaGrowth, 0.0)) {
        return 0.0;
    }
    return conductance(efficiency, areaGrowth, permittivity) * netDrive(drive) * relaxationFactor(relaxation);
}

double pairRelaxation(double sumA, double sumB, double numberA, double numberB)
{
    return std::max(sumA + numberB, sumB + numberA);
}

double chargeGainedFrozen(const ContactDrive& drive, double efficiency, double areaGrowth, double permittivity)
{
    if (std::islessequal(areaGrowth, 0.0)) {
        return 0.0;
    }
    return conductance(efficiency, areaGrowth, permittivity) * netDrive(drive);
}

}  // namespace him
