// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/gasProperties.H"

#include "gas/gasTurbulence.H"

#include "settings/checkedDictionary.H"

#include "dem_coupling/gas/drag_law.hpp"

namespace him {

bool hasGas(const Foam::fileName& casePath)
{
    return checkedDictionary::exists(casePath, gasFile);
}

gasProperties readGasProperties(const Foam::fileName& casePath, Complaints& complaints)
{
    gasProperties gas;
    GasSettings& exchange = gas.exchange;
    checkedDictionary entries(casePath, gasFile, complaints);
    exchange.density = entries.positive("density");
    exchange.viscosity = entries.positive("viscosity");
    if (!entries.has("gravity")) {
        entries.complain("gravity",
                         "the entry is missing. Write the gravity of the DEM script, like (0 0 -9.81); it gives "
                         "particles their buoyancy.");
    }
    exchange.gravity = entries.vector("gravity", Vector3::Zero());
    const std::string drag = entries.oneOf("drag", dragLawNames());
    exchange.drag = drag.empty() ? dragLawNames().front() : drag;
    const std::string model = entries.oneOf("voidFraction", voidFractionModelNames());
    exchange.voidFraction = model == "divided"    ? VoidFractionModel::divided
                            : model == "smoothed" ? VoidFractionModel::smoothed
                                                  : VoidFractionModel::centre;
    if (model == "smoothed") {
        exchange.smoothingLength = entries.positive("smoothingLength");
    } else if (entries.has("smoothingLength")) {
        entries.complain("smoothingLength",
                         "only voidFraction smoothed reads it. Write voidFraction smoothed;, or remove it.");
    }
    exchange.smallestVoidFraction = entries.positive("smallestVoidFraction", exchange.smallestVoidFraction);
    if (exchange.smallestVoidFraction >= 1) {
        entries.complain("smallestVoidFraction",
                         "found " + shown(exchange.smallestVoidFraction) + ", but a number below one is expected.");
    }
    exchange.pressure = entries.oneOf("pressureModel", {"modelA", "modelB"}, "modelA") == "modelB"
                            ? PressureModel::modelB
                            : PressureModel::modelA;
    exchange.velocity = entries.oneOf("velocityInterpolation", velocityInterpolationNames(), "cell") == "cellPoint"
                            ? VelocityInterpolation::cellPoint
                            : VelocityInterpolation::cell;
    gas.turbulence = gasTurbulence::modelOf(casePath, complaints);
    exchange.virtualMass = entries.number("virtualMass", 0);
    if (exchange.virtualMass < 0) {
        entries.complain("virtualMass", "found " + shown(exchange.virtualMass)
                                            + ", but 0 (none) or a number above is expected; a sphere has 0.5.");
    }
    exchange.saffmanLift = entries.oneOf("lift", {"none", "Saffman"}, "none") == "Saffman";
    gas.adjustTimeStep = entries.yesNo("adjustTimeStep", false);
    for (const char* entry : {"maxCo", "maxDeltaT"}) {
        if (!gas.adjustTimeStep && entries.has(entry)) {
            entries.complain(entry, "only adjustTimeStep yes reads it. Write that, or remove it.");
        }
    }
    gas.maxCo = entries.positive("maxCo", gas.maxCo);
    gas.maxDeltaT = entries.has("maxDeltaT") ? entries.positive("maxDeltaT", 1) : 0;
    gas.largestParticle = entries.has("largestParticle") ? entries.positive("largestParticle", 1) : 0;
    entries.refuseUnknownEntries();
    gas.pimple = pimpleControls::read(casePath, complaints);
    return gas;
}

}  // namespace him
