// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/liggghts/word_reader.hpp"

namespace him {

/// Limits the force of the electric field on a particle to |F| <= factor m skin/dt^2 (page of enable_electric_field): a force
/// of m skin/dt^2 carries a particle at rest over the skin of the neighbour lists in one step. Off by default; every hit counts.
struct ForceLimiter {
    bool active = false;
    double factor = 1e-3;  ///< above 0, at most 1
    double hits = 0;       ///< particles and steps in which it acted, this rank

    /// Factor [-] to multiply a force of that size [N] with.
    double share(double force, double mass, double skin, double timeStep)
    {
        const double largest = factor * mass * skin / (timeStep * timeStep);
        if (force <= largest) {
            return 1;
        }
        hits += 1;
        return largest / force;
    }
};

/// Reads the word behind field_force_limit_factor.
inline double readLimitFactor(WordReader& words, Complaints& complaints)
{
    const double factor = words.number("field_force_limit_factor");
    if (!(factor > 0 && factor <= 1)) {
        complaints.add("field_force_limit_factor", "found " + words.last()
                                                       + ", but a number above 0 and up to 1 is expected; 0 "
                                                         "would take all forces of the field away");
    }
    return factor;
}

/// Takes `limit_field_force` and `field_force_limit_factor` with the word behind them; false for any other keyword.
inline bool readLimiter(const std::string& keyword, WordReader& words, ForceLimiter& limiter, Complaints& complaints)
{
    if (keyword == "limit_field_force") {
        limiter.active = words.oneOf(keyword, {"no", "yes"}) == 1;
        return true;
    }
    if (keyword == "field_force_limit_factor") {
        limiter.factor = readLimitFactor(words, complaints);
        return true;
    }
    return false;
}

}  // namespace him
