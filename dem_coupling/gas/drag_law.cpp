// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/drag_law.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace him {

namespace {

/// Below this Reynolds number laws with Re in a denominator or a logarithm take their limit: no sum changes in its last digit.
constexpr double creeping = 1e-12;

/// Drag of a single sphere is 0.44 up to the drag crisis.
constexpr double dragCrisis = 2e5;

bool wenYuHolds(const DragPoint& at)
{
    return at.voidFraction >= 0.4 && superficialReynolds(at) <= dragCrisis;
}

bool schillerNaumannHolds(const DragPoint& at)
{
    // Neighbours add 5 % at 0.98 by Wen and Yu's voidFraction^-2.65.
    return at.voidFraction >= 0.98 && at.density * at.slip * at.diameter / at.viscosity <= dragCrisis;
}

bool gidaspowHolds(const DragPoint& at)
{
    // Ergun drew his measurements over Re/(1 - voidFraction).
    return at.voidFraction >= 0.8 ? wenYuHolds(at)
                                  : at.voidFraction >= 0.36 && superficialReynolds(at) <= 2500 * (1 - at.voidFraction);
}

bool beetstraHolds(const DragPoint& at)
{
    return at.voidFraction >= 0.4 && at.voidFraction <= 0.9 && superficialReynolds(at) <= 1000;
}

bool diFeliceHolds(const DragPoint& at)
{
    return at.voidFraction >= 0.4 && superficialReynolds(at) <= 1e4;
}

bool kochHillHolds(const DragPoint& at)
{
    return at.voidFraction >= 0.36 && superficialReynolds(at) <= 120;
}

/// One after the other.
template <double (*law)(const DragPoint&)> void ofMany(const DragPoints& points, Scalars& beta)
{
    beta.resize(points.rows());
    for (Index row = 0; row < points.rows(); ++row) {
        beta[row] = law(points.at(row));
    }
}

struct Entry {
    const char* name;
    DragOfMany ofMany;
    DragLawRange holds;
    const char* range;
};
constexpr std::array<Entry, 6> laws{{
    {"WenYu", &wenYuDragOfMany, &wenYuHolds, "void fraction from 0.4, Re up to 2e5"},
    {"SchillerNaumann", &ofMany<schillerNaumannDrag>, &schillerNaumannHolds, "void fraction from 0.98, Re up to 2e5"},
    {"Gidaspow", &ofMany<gidaspowDrag>, &gidaspowHolds,
     "void fraction from 0.36, Re/(1 - void fraction) up to 2500 below void fraction 0.8, Re up to 2e5 above"},
    {"Beetstra", &ofMany<beetstraDrag>, &beetstraHolds, "void fraction 0.4 to 0.9, Re up to 1000"},
    {"DiFelice", &ofMany<diFeliceDrag>, &diFeliceHolds, "void fraction from 0.4, Re up to 1e4"},
    {"KochHill", &ofMany<kochHillDrag>, &kochHillHolds, "void fraction from 0.36, Re up to 120"},
}};

const Entry& entryOf(const std::string& name)
{
    const auto* found = std::find_if(laws.begin(), laws.end(), [&](const Entry& law) { return name == law.name; });
    if (found == laws.end()) {
        std::string known;
        for (const Entry& law : laws) {
            known += (known.empty() ? "" : ", ") + std::string(law.name);
        }
        throw std::invalid_argument("unknown drag law '" + name + "'; known: " + known);
    }
    return *found;
}

}  // namespace

std::vector<std::string> dragLawNames()
{
    std::vector<std::string> names;
    for (const Entry& law : laws) {
        names.emplace_back(law.name);
    }
    return names;
}

DragOfMany dragOfMany(const std::string& name)
{
    return entryOf(name).ofMany;
}

DragLawRange dragLawRange(const std::string& name)
{
    return entryOf(name).holds;
}

std::string dragLawRangeInWords(const std::string& name)
{
    return entryOf(name).range;
}

DragLawSet dragLawsThatHold(const DragPoint& at)
{
    DragLawSet set = 0;
    for (std::size_t n = 0; n < laws.size(); ++n) {
        set |= laws[n].holds(at) ? DragLawSet(1) << n : 0;
    }
    return set;
}

std::vector<std::string> dragLawNames(DragLawSet set)
{
    std::vector<std::string> names;
    for (std::size_t n = 0; n < laws.size(); ++n) {
        if (set >> n & 1) {
            names.emplace_back(laws[n].name);
        }
    }
    return names;
}

double ergunDrag(const DragPoint& at)
{
    const double solid = 1 - at.voidFraction;
    const double volume = pi * at.diameter * at.diameter * at.diameter / 6;
    return volume
           * (150 * solid * at.viscosity / (at.voidFraction * at.diameter * at.diameter)
              + 1.75 * at.density * at.slip / at.diameter);
}

double gidaspowDrag(const DragPoint& at)
{
    return at.voidFraction < 0.8 ? ergunDrag(at) : wenYuDrag(at);
}

double beetstraDrag(const DragPoint& at)
{
    // The paper's F is model A's drag over 3 pi mu d times the superficial slip, voidFraction times the slip: its creeping
    // part in packed beds, 10 solid/gas^2, is Carman's 180 without the share of the pressure gradient.
    const double gas = at.voidFraction;
    const double solid = std::max(1 - gas, 0.0);  // round-off of a smoothed void fraction
    const double reynolds = superficialReynolds(at);
    double force = 10 * solid / (gas * gas) + gas * gas * (1 + 1.5 * std::sqrt(solid));
    if (reynolds > creeping) {
        force += 0.413 * reynolds / (24 * gas * gas) * (1 / gas + 3 * gas * solid + 8.4 * std::pow(reynolds, -0.343))
                 / (1 + std::pow(10, 3 * solid) * std::pow(reynolds, -0.5 * (1 + 4 * solid)));
    }
    return stokesDrag(at) * gas * force;
}

double diFeliceDrag(const DragPoint& at)
{
    const double reynolds = std::max(superficialReynolds(at), creeping);
    const double root = 0.63 * std::sqrt(reynolds) + 4.8;
    const double distance = 1.5 - std::log10(reynolds);
    const double chi = 3.7 - 0.65 * std::exp(-0.5 * distance * distance);
    // Drag pi/8 C_D rho (alpha slip)^2 d^2 alpha^-chi with C_D Re = root^2. chi tends to 3.7, model A's exponent (Richardson
    // and Zaki's 4.7 is that of the whole force).
    return pi / 8 * at.viscosity * at.diameter * root * root * std::pow(at.voidFraction, 1 - chi);
}

double kochHillDrag(const DragPoint& at)
{
    const double gas = at.voidFraction;
    const double solid = std::max(1 - gas, 0.0);
    double creepingForce = 10 * solid / (gas * gas * gas);
    if (solid < 0.4) {
        const double logarithm = solid > 0 ? 135.0 / 64 * solid * std::log(solid) : 0;
        creepingForce = (1 + 3 * std::sqrt(solid / 2) + logarithm + 16.14 * solid)
                        / (1 + 0.681 * solid - 8.48 * solid * solid + 8.16 * solid * solid * solid);
    }
    const double inertia = 0.0673 + 0.212 * solid + 0.0232 / std::pow(gas, 5);
    // 18 mu alpha^2 (1 - alpha)/d^2 (F0 + F3 Re/2) per volume, Re of the superficial slip on the diameter.
    return stokesDrag(at) * gas * gas * (creepingForce + 0.5 * inertia * superficialReynolds(at));
}

}  // namespace him
