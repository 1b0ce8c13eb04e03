// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charging_pairs.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace him {
namespace {

std::string pairName(int first, int second)
{
    return "pair " + std::to_string(first) + " " + std::to_string(second);
}

void requireFiniteLaw(const std::string& name, const SaturationLaw& law)
{
    if (!std::isfinite(law.density) || !std::isfinite(law.potential)) {
        throw std::invalid_argument(name + ": the saturation must be given by finite numbers");
    }
}

}  // namespace

ChargingPairs::ChargingPairs(int types)
    : types_(types),
      pairs_(static_cast<std::size_t>(types) * types),
      materials_(static_cast<std::size_t>(types) + 1),
      spreads_(static_cast<std::size_t>(types) + 1)
{
}

// ---------------------------------------------------------------------- pairs

void ChargingPairs::claim(int first, int second)
{
    for (const int type : {first, second}) {
        if (type < 1 || type > types_) {
            throw std::invalid_argument(pairName(first, second) + ": there is no type " + std::to_string(type)
                                        + "; the box has types 1 to " + std::to_string(types_));
        }
    }
    if (at(first, second).given) {
        throw std::invalid_argument(pairName(first, second)
                                    + " is given twice (a pair holds for both orders; Gamma changes sign by itself)");
    }
    at(first, second).given = true;
    at(second, first).given = true;
}

void ChargingPairs::transfer(int first, int second, double efficiency, LimitLaw law)
{
    claim(first, second);
    if (!std::isfinite(efficiency) || efficiency < 0) {
        throw std::invalid_argument(pairName(first, second) + ": kappa must be a finite number >= 0, found "
                                    + std::to_string(efficiency));
    }
    for (ChargingPair* pair : {&at(first, second), &at(second, first)}) {
        pair->transfers = true;
        pair->efficiency = pair->rate = efficiency;
        pair->law = law;
    }
}

void ChargingPairs::set(int first, int second, double transferLimit, double efficiency)
{
    transfer(first, second, efficiency, LimitLaw::given);
    const std::string name = pairName(first, second);
    if (!std::isfinite(transferLimit)) {
        throw std::invalid_argument(name + ": gamma must be a finite number [V/m]");
    }
    if (first == second && transferLimit != 0) {
        throw std::invalid_argument(name + ": gamma must be 0 between equal types, because Gamma_ij = -Gamma_ji");
    }
    at(first, second).transferLimit = transferLimit;
    at(second, first).transferLimit = -transferLimit;
}

void ChargingPairs::setAtWall(int first, int second, const SaturationLaw& law, double efficiency)
{
    const std::string name = pairName(first, second);
    if (first == second) {
        throw std::invalid_argument(name + ": a type does not saturate at itself. Between particles of one type write '" + name
                                    + " gamma 0 kappa <->' or '" + name + " saturation kappa <->'");
    }
    requireFiniteLaw(name, law);
    transfer(first, second, efficiency, LimitLaw::atWall);
    at(first, second).atWall = at(second, first).atWall = law;
    at(second, first).leads = false;
}

void ChargingPairs::setFromSaturations(int first, int second, double efficiency)
{
    transfer(first, second, efficiency, LimitLaw::saturations);
}

void ChargingPairs::setFromWorkFunctions(int first, int second, double efficiency)
{
    transfer(first, second, efficiency, LimitLaw::workFunctions);
}

void ChargingPairs::setNone(int first, int second)
{
    claim(first, second);
}

// ---------------------------------------------------------------------- types

ChargingPairs::Material& ChargingPairs::material(int type, const char* what)
{
    if (type < 1 || type > types_) {
        throw std::invalid_argument(std::string(what) + ": there is no type " + std::to_string(type) + "; the box has types 1 to "
                                    + std::to_string(types_));
    }
    return materials_[static_cast<std::size_t>(type)];
}

void ChargingPairs::setSaturation(int type, const SaturationLaw& law)
{
    Material& given = material(type, "saturation");
    const std::string name = "saturation of type " + std::to_string(type);
    if (given.saturation) {
        throw std::invalid_argument(name + " is given twice");
    }
    requireFiniteLaw(name, law);
    given.saturation = law;
}

void ChargingPairs::setWorkFunction(int type, double workFunction)
{
    Material& given = material(type, "work function");
    const std::string name = "work function of type " + std::to_string(type);
    if (given.workFunction) {
        throw std::invalid_argument(name + " is given twice");
    }
    if (!std::isfinite(workFunction) || workFunction <= 0) {
        std::ostringstream found;
        found << workFunction;
        throw std::invalid_argument(name + " must be a number above zero, found " + found.str() + " J");
    }
    if (workFunction > 1e-16) {
        std::ostringstream found;
        found << workFunction;
        throw std::invalid_argument(name + " is " + found.str()
                                    + " J, more than 600 eV, and those of solids are a few eV. Write electron volts with "
                                      "'workFunctionEV', joules with 'workFunction'");
    }
    given.workFunction = workFunction;
}

void ChargingPairs::setSpread(int type, const ParticleSpread& spread)
{
    Material& given = material(type, "spread");
    if (given.spread.deviation != 0) {
        throw std::invalid_argument("spread of type " + std::to_string(type) + " is given twice");
    }
    if (!std::isfinite(spread.deviation) || spread.deviation < 0) {
        throw std::invalid_argument("spread of type " + std::to_string(type) + ": the standard deviation must be a number >= 0");
    }
    given.spread = spread;
}

void ChargingPairs::setWorkFunctionSpread(int type, const ParticleSpread& spread)
{
    setSpread(type, spread);
    materials_[static_cast<std::size_t>(type)].spreadOfWorkFunction = true;
}

// ---------------------------------------------------------------------- all pairs

void ChargingPairs::setSeparation(double separation)
{
    if (!std::isfinite(separation) || separation <= 0) {
        throw std::invalid_argument("deltaE must be a length above zero [m]");
    }
    separation_ = separation;
}

void ChargingPairs::setAcceleration(double acceleration)
{
    if (!std::isfinite(acceleration) || acceleration <= 0) {
        throw std::invalid_argument("acceleration must be a number above zero");
    }
    acceleration_ = acceleration;
}

void ChargingPairs::setSoftening(int first, int second, double correction)
{
    at(first, second).softening = at(second, first).softening = correction;
}

Complaints ChargingPairs::check() const
{
    Complaints complaints;
    std::set<int> usesWorkFunction, usesSaturation, usesOther;
    for (int first = 1; first <= types_; ++first) {
        for (int second = first; second <= types_; ++second) {
            const ChargingPair& pair = of(first, second);
            if (!pair.transfers) {
                continue;
            }
            auto& users = pair.law == LimitLaw::workFunctions ? usesWorkFunction
                          : pair.law == LimitLaw::saturations ? usesSaturation
                                                              : usesOther;
            users.insert({first, second});
            if (pair.law == LimitLaw::workFunctions) {
                for (const int type : std::set<int>{first, second}) {
                    if (!materials_[static_cast<std::size_t>(type)].workFunction) {
                        complaints.add(pairName(first, second), "type " + std::to_string(type)
                                                                    + " has no work function. Add 'workFunction " + std::to_string(type)
                                                                    + " <J>' or 'workFunctionEV " + std::to_string(type) + " <eV>'");
                    }
                }
            }
            if (pair.law == LimitLaw::saturations && !materials_[static_cast<std::size_t>(first)].saturation
                && !materials_[static_cast<std::size_t>(second)].saturation) {
                complaints.add(pairName(first, second), "neither type has a saturation. Add 'saturationCharge <type> <C> radius <m>' or "
                                                        "'sizeLaw <type> <C/m2> <V>' for the particles");
            }
        }
    }
    for (int type = 1; type <= types_; ++type) {
        const Material& given = materials_[static_cast<std::size_t>(type)];
        const std::string name = "type " + std::to_string(type);
        if (given.workFunction && !usesWorkFunction.count(type)) {
            complaints.add(name, "its work function is used by no pair. Write 'pair <I> <J> workFunctions kappa <->'");
        }
        if (given.saturation && !usesSaturation.count(type)) {
            complaints.add(name, "its saturation is used by no pair. Write 'pair <I> <J> saturation kappa <->'");
        }
        if (given.spreadOfWorkFunction && (!usesWorkFunction.count(type) || usesSaturation.count(type) || usesOther.count(type))) {
            complaints.add(name, "a spread of the work function needs all its pairs to be 'workFunctions'. Use 'spread <type> gamma "
                                 "<V/m> seed <n>' with other laws");
        }
    }
    return complaints;
}

void ChargingPairs::resolvePair(int first, int second, double permittivity)
{
    ChargingPair& pair = at(first, second);
    const Material& a = materials_[static_cast<std::size_t>(first)];
    const Material& b = materials_[static_cast<std::size_t>(second)];
    if (pair.law == LimitLaw::workFunctions && a.workFunction && b.workFunction) {
        pair.transferLimit = transferLimitOfWorkFunctions(*a.workFunction, *b.workFunction, separation_);
    } else if (pair.law == LimitLaw::atWall || pair.law == LimitLaw::saturations) {
        const bool atWall = pair.law == LimitLaw::atWall;
        const SaturationLaw nothing;
        const SaturationLaw ofA = atWall ? (pair.leads ? pair.atWall : nothing) : a.saturation.value_or(nothing);
        const SaturationLaw ofB = atWall ? (pair.leads ? nothing : pair.atWall) : b.saturation.value_or(nothing);
        pair.transferLimit = (ofA.density - ofB.density) / permittivity;
        pair.potentialFirst = ofA.potential;
        pair.potentialSecond = ofB.potential;
    }
    pair.rate = pair.efficiency * pair.softening * acceleration_;
}

void ChargingPairs::resolve(double permittivity)
{
    for (int first = 1; first <= types_; ++first) {
        for (int second = 1; second <= types_; ++second) {
            if (of(first, second).transfers) {
                resolvePair(first, second, permittivity);
            }
        }
    }
    anySpread_ = false;
    for (std::size_t type = 1; type < materials_.size(); ++type) {
        spreads_[type] = materials_[type].spread;
        if (materials_[type].spreadOfWorkFunction) {
            // A higher work function makes Gamma lower; the sign of a symmetric spread is a convention.
            spreads_[type].deviation *= -1 / (separation_ * elementaryCharge);
        }
        anySpread_ = anySpread_ || spreads_[type].deviation != 0;
    }
}

// ---------------------------------------------------------------------- texts

void ChargingPairs::describeLaw(int first, int second, std::string& text) const
{
    const ChargingPair& pair = of(first, second);
    std::ostringstream words;
    words << "Gamma " << pair.transferLimit << " V/m";
    const auto potential = [&](double value, char sign, int type) {
        if (value != 0) {
            words << ' ' << sign << ' ' << value << " V/radius of type " << type;
        }
    };
    potential(pair.potentialFirst, '+', first);
    potential(pair.potentialSecond, '-', second);
    words << " (for type " << first;
    switch (pair.law) {
        case LimitLaw::given: break;
        case LimitLaw::atWall: words << ", from saturation at the wall, R17 R19"; break;
        case LimitLaw::saturations: words << ", from the saturation of both, R18 R19"; break;
        case LimitLaw::workFunctions: words << ", from work functions, deltaE " << separation_ << " m"; break;
    }
    words << "), kappa " << pair.efficiency;
    if (pair.softening != 1) {
        words << ", a_corr " << pair.softening;
    }
    text += words.str();
}

std::string ChargingPairs::describe() const
{
    std::string text;
    for (int first = 1; first <= types_; ++first) {
        for (int second = first; second <= types_; ++second) {
            if (!of(first, second).given) {
                continue;
            }
            text += "    types " + std::to_string(first) + " and " + std::to_string(second) + ": ";
            if (of(first, second).transfers) {
                describeLaw(first, second, text);
            } else {
                text += "no charge transfer";
            }
            text += '\n';
        }
    }
    for (int type = 1; type <= types_; ++type) {
        const ParticleSpread& spread = materials_[static_cast<std::size_t>(type)].spread;
        if (spread.deviation != 0) {
            std::ostringstream words;
            words << "    spread over the particles of type " << type << ": standard deviation " << spread.deviation
                  << (materials_[static_cast<std::size_t>(type)].spreadOfWorkFunction ? " J of the work function" : " V/m of Gamma")
                  << ", seed " << spread.seed << '\n';
            text += words.str();
        }
    }
    return text;
}

void ChargingPairs::complainAboutMissing(const std::vector<int>& particleTypes, const std::vector<int>& wallTypes,
                                         const std::string& where, Complaints& complaints) const
{
    std::set<std::pair<int, int>> touching;
    for (const int particle : particleTypes) {
        for (const int other : particleTypes) {
            touching.insert(std::minmax(particle, other));
        }
        for (const int wall : wallTypes) {
            touching.insert(std::minmax(particle, wall));
        }
    }
    for (const auto& [first, second] : touching) {
        if (!of(first, second).given) {
            const std::string name = pairName(first, second);
            complaints.add(where, "Gamma and kappa are missing for types " + std::to_string(first) + " and "
                                      + std::to_string(second) + ", which can touch. Add '" + name
                                      + " gamma <V/m> kappa <->', or '" + name + " none' for no charge transfer.");
        }
    }
}

}  // namespace him
