// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/transfer_limit.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/require.hpp"

namespace him {

SaturationLaw saturationOfSphere(double charge, double radius)
{
    requirePositive("radius", radius);
    return {charge / (4.0 * pi * radius * radius), 0.0};
}

double transferLimitAtWall(const SaturationLaw& law, double radius, double permittivity)
{
    requirePositive("radius", radius);
    requirePositive("permittivity", permittivity);
    return law.density / permittivity + law.potential / radius;
}

double transferLimitOfSpheres(const SaturationLaw& lawI, double radiusI, const SaturationLaw& lawJ, double radiusJ,
                              double permittivity)
{
    return transferLimitAtWall(lawI, radiusI, permittivity) - transferLimitAtWall(lawJ, radiusJ, permittivity);
}

double transferLimitOfWorkFunctions(double workFunctionI, double workFunctionJ, double separation)
{
    requirePositive("work function", workFunctionI);
    requirePositive("work function", workFunctionJ);
    requirePositive("delta_e", separation);
    return (workFunctionJ - workFunctionI) / (separation * elementaryCharge);
}

}  // namespace him
