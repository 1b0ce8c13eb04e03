// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charging_pairs.hpp"

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

}  // namespace

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

void ChargingPairs::set(int first, int second, double transferLimit, double efficiency)
{
    claim(first, second);
    const std::string name = pairName(first, second);
    if (!std::isfinite(transferLimit)) {
        throw std::invalid_argument(name + ": gamma must be a finite number [V/m]");
    }
    if (!std::isfinite(efficiency) || efficiency < 0) {
        throw std::invalid_argument(name + ": kappa must be a finite number >= 0, found " + std::to_string(efficiency));
    }
    if (first == second && transferLimit != 0) {
        throw std::invalid_argument(name + ": gamma must be 0 between equal types, because Gamma_ij = -Gamma_ji");
    }
    at(first, second).transfers = at(second, first).transfers = true;
    at(first, second).transferLimit = transferLimit;
    at(second, first).transferLimit = -transferLimit;
    at(first, second).efficiency = at(second, first).efficiency = efficiency;
}

void ChargingPairs::setNone(int first, int second)
{
    claim(first, second);
}

std::string ChargingPairs::describe() const
{
    std::ostringstream text;
    for (int first = 1; first <= types_; ++first) {
        for (int second = first; second <= types_; ++second) {
            const ChargingPair& pair = of(first, second);
            if (!pair.given) {
                continue;
            }
            text << "    types " << first << " and " << second << ": ";
            if (pair.transfers) {
                text << "Gamma " << pair.transferLimit << " V/m (for type " << first << "), kappa " << pair.efficiency;
            } else {
                text << "no charge transfer";
            }
            text << '\n';
        }
    }
    return text.str();
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
