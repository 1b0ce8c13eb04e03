// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/impact_area.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/require.hpp"

namespace him {

namespace {

double compliance(const Elasticity& body)
{
    requirePositive("Young's modulus", body.youngsModulus);
    if (!std::isgreater(body.poissonRatio, -1.0) || !std::islessequal(body.poissonRatio, 0.5)) {
        rejectArgument("Poisson's ratio", "above -1 and at most 0.5", body.poissonRatio);
    }
    return (1.0 - body.poissonRatio * body.poissonRatio) / body.youngsModulus;
}

double mass(const ImpactBody& sphere)
{
    requirePositive("radius", sphere.radius);
    requirePositive("density", sphere.density);
    return 4.0 / 3.0 * pi * sphere.radius * sphere.radius * sphere.radius * sphere.density;
}

double impactArea(double effectiveMass, double modulus, double radius, double normalSpeed, AreaLaw law)
{
    return contactArea(law, radius, hertzImpactOverlap(effectiveMass, modulus, radius, normalSpeed));
}

}  // namespace

double effectiveModulus(const Elasticity& a, const std::optional<Elasticity>& b)
{
    return 1.0 / (compliance(a) + (b ? compliance(*b) : 0.0));
}

double impactAreaAtWall(const ImpactBody& sphere, const std::optional<Elasticity>& wall, double normalSpeed,
                        AreaLaw law)
{
    return impactArea(mass(sphere), effectiveModulus(sphere.elasticity, wall), sphere.radius, normalSpeed, law);
}

double impactAreaOfSpheres(const ImpactBody& a, const ImpactBody& b, double normalSpeed, AreaLaw law)
{
    const double effectiveMass = mass(a) * mass(b) / (mass(a) + mass(b));
    return impactArea(effectiveMass, effectiveModulus(a.elasticity, b.elasticity), effectiveRadius(a.radius, b.radius),
                      normalSpeed, law);
}

}  // namespace him
