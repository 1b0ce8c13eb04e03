// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charge_losses.hpp"
#include "dem_coupling/charging/charging_pairs.hpp"
#include "dem_coupling/charging/initial_charge.hpp"
#include "dem_coupling/dem_port.hpp"
#include "electrostatics/parameters/charging_efficiency.hpp"

#include <map>
#include <string>
#include <vector>

namespace him {

/// What a line `fix ID group charge/gran/contact ...` says. See doc/charge_gran_contact.md.
struct ChargeGranContactOptions {
    explicit ChargeGranContactOptions(int types) : pairs(types), initial(types) {}

    ChargingPairs pairs;
    AreaLaw area = AreaLaw::hertz;
    Reloading reloading = Reloading::counted;
    double curvature = 10;  ///< [degrees]
    WithinContact update = WithinContact::updated;
    bool ownImage = false;
    bool atContactPoint = false;       ///< where the field of the others is taken at walls
    std::map<int, double> realModuli;  ///< Young's modulus [Pa] by type, where the DEM's is softened
    ChargeLosses losses;
    InitialCharges initial;
    std::vector<WallRole> walls;  ///< of `wall NAME ...`
};

/// Reads the words behind the style name. Throws std::invalid_argument with everything that is wrong.
/// @param types  number of atom types of the box
ChargeGranContactOptions readChargeGranContactOptions(const std::vector<std::string>& words, int types);

}  // namespace him
