// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/wall_equilibrium.hpp"

#include <iomanip>
#include <sstream>

namespace him {

std::string describe(const std::vector<WallEquilibrium>& equilibria)
{
    if (equilibria.empty()) {
        return {};
    }
    std::ostringstream table;
    const auto cells = [&table](const auto& type, const auto& diameter, const auto& limit, const auto& charge, const auto& ratio,
                                const std::string& walls) {
        table << "    " << std::left << std::setw(8) << type << std::setw(16) << diameter << std::setw(16) << limit
              << std::setw(16) << charge << std::setw(12) << ratio << walls << '\n';
    };
    cells("type", "diameter [m]", "Gamma [V/m]", "q_eq [C]", "e/g", "walls");
    for (const WallEquilibrium& one : equilibria) {
        std::string walls;
        for (const std::string& wall : one.walls) {
            walls += (walls.empty() ? "" : ", ") + wall;
        }
        if (one.forceOverWeight > 0) {
            cells(one.particleType, one.diameter, one.transferLimit, one.charge, one.forceOverWeight, walls);
        } else {
            cells(one.particleType, one.diameter, one.transferLimit, one.charge, "n/a", walls);
        }
    }
    return table.str();
}

}  // namespace him
