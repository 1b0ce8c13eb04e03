// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/initial_charge.hpp"

#include "electrostatics/contact_charging.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace him {

InitialCharges::Rule& InitialCharges::claim(int type)
{
    if (type < 1 || type >= static_cast<int>(rules_.size())) {
        throw std::invalid_argument("initialCharge: there is no type " + std::to_string(type) + "; the box has types 1 to "
                                    + std::to_string(rules_.size() - 1));
    }
    Rule& rule = rules_[static_cast<std::size_t>(type)];
    if (rule.given) {
        throw std::invalid_argument("initialCharge of type " + std::to_string(type) + " is given twice");
    }
    rule.given = true;
    any_ = true;
    return rule;
}

void InitialCharges::setValue(int type, double charge)
{
    claim(type).mean = charge;
}

void InitialCharges::setNormal(int type, double mean, const ParticleSpread& spread)
{
    Rule& rule = claim(type);
    if (!std::isfinite(spread.deviation) || spread.deviation < 0) {
        throw std::invalid_argument("initialCharge of type " + std::to_string(type) + ": the standard deviation must be >= 0");
    }
    rule.mean = mean;
    rule.spread = spread;
}

void InitialCharges::setEquilibriumFraction(int type, double fraction, int wallType)
{
    Rule& rule = claim(type);
    if (wallType < 1 || wallType >= static_cast<int>(rules_.size())) {
        throw std::invalid_argument("initialCharge of type " + std::to_string(type) + ": there is no wall type " + std::to_string(wallType));
    }
    rule.fraction = fraction;
    rule.wallType = wallType;
}

void InitialCharges::check(const ChargingPairs& pairs, Complaints& complaints) const
{
    for (std::size_t type = 1; type < rules_.size(); ++type) {
        const Rule& rule = rules_[type];
        if (rule.wallType > 0 && !pairs.of(static_cast<int>(type), rule.wallType).transfers) {
            complaints.add("initialCharge " + std::to_string(type), "an equilibrium fraction needs a Gamma against type "
                                                                        + std::to_string(rule.wallType) + ". Give that pair a law");
        }
    }
}

double InitialCharges::of(int type, int tag, double radius, const ChargingPairs& pairs, double permittivity) const
{
    const Rule& rule = rules_[static_cast<std::size_t>(type)];
    if (rule.wallType > 0) {
        const double limit = pairs.of(type, rule.wallType).limit(radius, 0) + pairs.spreadOf(type, tag);
        return rule.fraction * saturationCharge(limit, radius, permittivity);
    }
    return rule.mean + rule.spread.of(tag);
}

std::string InitialCharges::describe() const
{
    std::ostringstream text;
    for (std::size_t type = 1; type < rules_.size(); ++type) {
        const Rule& rule = rules_[type];
        if (!rule.given) {
            continue;
        }
        text << "    initial charge of type " << type << ": ";
        if (rule.wallType > 0) {
            text << rule.fraction << " of the saturation charge at walls of type " << rule.wallType;
        } else {
            text << rule.mean << " C";
        }
        if (rule.spread.deviation != 0) {
            text << ", standard deviation " << rule.spread.deviation << " C, seed " << rule.spread.seed;
        }
        text << '\n';
    }
    return text.str();
}

}  // namespace him
