// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/parameters/branch.hpp"
#include "electrostatics/parameters/charging_efficiency.hpp"
#include "electrostatics/parameters/impact_area.hpp"
#include "electrostatics/parameters/measured.hpp"

#include <optional>
#include <string>
#include <vector>

namespace him {

/// A particle of a charging experiment.
struct MeasuredBody {
    Measured radius = Measured::exact(0);  ///< [m]
    double density = 0;                    ///< [kg/m3], where the area comes from the impact speed
    Elasticity elasticity;
    Measured initialCharge = Measured::exact(0);  ///< [C]
    std::optional<Measured> saturationCharge;     ///< [C]
    std::optional<Measured> transferLimit;        ///< Gamma at the wall [V/m], in place of the saturation charge
};

/// A charging experiment: what was measured, and at what contact.
struct Measurement {
    bool atWall = true;                      ///< particle-wall, else particle-particle
    bool similar = false;                    ///< the partner is of the same material and size
    MeasuredBody particle;                   ///< i: charge transfers are gains of this one
    MeasuredBody partner;                    ///< j of a pair; of a similar one only its charge counts
    std::optional<Measured> chargeTransfer;  ///< of one contact [C]

    AreaLaw areaLaw = AreaLaw::hertz;
    std::optional<Measured> area;         ///< growth of the contact area [m2], as a DEM run reports it
    std::optional<Measured> normalSpeed;  ///< [m/s], where the area follows from the impact
    std::optional<Elasticity> wall;       ///< an elastic wall; rigid without

    std::vector<double> historyContacts;  ///< numbers of contacts before the readings
    std::vector<double> historyCharges;   ///< readings [C]
};

/// Parameters that a measurement gives. What its branch does not give is empty.
struct ChargingParameters {
    Branch branch = Branch::particleWall;
    std::optional<Estimate> contactArea;           ///< [m2]
    std::optional<Estimate> transferLimit;         ///< Gamma [V/m], positive drives charge to the particle
    std::optional<Estimate> saturationCharge;      ///< of the particle at the wall [C]
    std::optional<Estimate> efficiencyUpdated;     ///< kappa_c [-] for the law with charges updated within a contact
    std::optional<Estimate> efficiencyFrozen;      ///< kappa_c [-] as R20 to R23 define it
    std::optional<Estimate> limitTimesEfficiency;  ///< Gamma kappa_c [V/m]
    std::optional<Estimate> contactsTo95;          ///< contacts of an uncharged particle to 95 % of saturation [-]
};

/// The branch of a measurement. Throws std::invalid_argument that says what is missing.
Branch branchOf(const Measurement& measurement);

/// Everything that is physically impossible in a measurement, one sentence each: a radius, an area or a speed that is not
/// positive, a charge beyond saturation, a transfer of the wrong sign or beyond equilibrium, ... Empty when there is nothing.
std::vector<std::string> faultsOf(const Measurement& measurement);

/// The parameters, with intervals. Throws std::invalid_argument when some combination of the inputs within their intervals
/// is impossible, although the averages have no fault.
ChargingParameters parametersOf(const Measurement& measurement);

}  // namespace him
