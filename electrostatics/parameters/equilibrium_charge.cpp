// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/equilibrium_charge.hpp"

#include "electrostatics/constants.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace him {

namespace {

void requirePositive(const char* name, double value)
{
    if (!(value > 0) || !std::isfinite(value)) {
        throw std::invalid_argument(std::string(name) + " must be a finite number above 0, found " + std::to_string(value));
    }
}

}  // namespace

double equilibriumCharge(double transferLimit, double diameter, double permittivity)
{
    requirePositive("diameter", diameter);
    requirePositive("permittivity", permittivity);
    return pi * permittivity * diameter * diameter * transferLimit;
}

double forceOverWeight(double charge, double diameter, double permittivity, double mass, double gravity)
{
    requirePositive("diameter", diameter);
    requirePositive("permittivity", permittivity);
    requirePositive("mass", mass);
    requirePositive("gravity", gravity);
    return charge * charge / (4 * pi * permittivity * diameter * diameter) / (mass * gravity);
}

double transferLimitFor(double ratio, double diameter, double permittivity, double mass, double gravity)
{
    if (!(ratio >= 0) || !std::isfinite(ratio)) {
        throw std::invalid_argument("e/g must be a finite number not below 0, found " + std::to_string(ratio));
    }
    const double unit = forceOverWeight(equilibriumCharge(1, diameter, permittivity), diameter, permittivity, mass, gravity);
    return std::sqrt(ratio / unit);
}

}  // namespace him
