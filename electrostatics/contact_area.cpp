// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/contact_area.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/require.hpp"

#include <cmath>
#include <stdexcept>

namespace him {

namespace {

/// Time of an elastic Hertz impact times v / delta_max: (4/5) sqrt(pi) Gamma(2/5) / Gamma(9/10).
constexpr double hertzTimeFactor = 2.9432751843247;

}  // namespace

AreaLaw areaLawByName(const std::string& name)
{
    if (name == "hertz") {
        return AreaLaw::hertz;
    }
    if (name == "doubled") {
        return AreaLaw::doubled;
    }
    throw std::invalid_argument("unknown contact area law \"" + name + "\"; known: hertz, doubled");
}

std::string nameOf(AreaLaw law)
{
    return law == AreaLaw::hertz ? "hertz" : "doubled";
}

double effectiveRadius(double radiusA, double radiusB)
{
    requirePositive("radius", radiusA);
    requirePositive("radius", radiusB);
    return radiusA * radiusB / (radiusA + radiusB);
}

double contactArea(AreaLaw law, double effectiveRadius, double overlap)
{
    requirePositive("effective radius", effectiveRadius);
    requireNotNegative("overlap", overlap);
    const double hertzArea = pi * effectiveRadius * overlap;
    return law == AreaLaw::hertz ? hertzArea : 2.0 * hertzArea;
}

double hertzImpactOverlap(double effectiveMass, double effectiveModulus, double effectiveRadius, double normalSpeed)
{
    requirePositive("effective mass", effectiveMass);
    requirePositive("effective modulus", effectiveModulus);
    requirePositive("effective radius", effectiveRadius);
    requireNotNegative("normal speed", normalSpeed);
    const double energy = 15.0 * effectiveMass * normalSpeed * normalSpeed;
    return std::pow(energy / (16.0 * effectiveModulus * std::sqrt(effectiveRadius)), 0.4);
}

double hertzImpactTime(double maximumOverlap, double normalSpeed)
{
    requirePositive("largest overlap", maximumOverlap);
    requirePositive("normal speed", normalSpeed);
    return hertzTimeFactor * maximumOverlap / normalSpeed;
}

double impactAreaOnRigidFlat(double radius, double density, double youngsModulus, double poissonRatio,
                             double normalSpeed)
{
    requirePositive("radius", radius);
    requirePositive("density", density);
    requirePositive("Young's modulus", youngsModulus);
    requireNotNegative("normal speed", normalSpeed);
    if (!std::isgreater(poissonRatio, -1.0) || !std::islessequal(poissonRatio, 0.5)) {
        rejectArgument("Poisson's ratio", "above -1 and at most 0.5", poissonRatio);
    }
    const double compliance = (1.0 - poissonRatio * poissonRatio) / youngsModulus;
    return pi * radius * radius * std::pow(1.25 * pi * density * compliance, 0.4) * std::pow(normalSpeed, 0.8);
}

double rayleighTimeStep(double radius, double density, double youngsModulus, double poissonRatio)
{
    requirePositive("radius", radius);
    requirePositive("density", density);
    requirePositive("Young's modulus", youngsModulus);
    if (!std::isgreater(poissonRatio, -1.0) || !std::islessequal(poissonRatio, 0.5)) {
        rejectArgument("Poisson's ratio", "above -1 and at most 0.5", poissonRatio);
    }
    const double shearModulus = youngsModulus / (2 * (1 + poissonRatio));
    return pi * radius * std::sqrt(density / shearModulus) / (0.1631 * poissonRatio + 0.8766);
}

double softeningCorrection(double softModulus, double realModulus)
{
    requirePositive("softened modulus", softModulus);
    requirePositive("real modulus", realModulus);
    return std::pow(softModulus / realModulus, 0.4);
}

}  // namespace him
