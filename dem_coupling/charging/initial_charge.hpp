// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charging_pairs.hpp"
#include "dem_coupling/charging/particle_random.hpp"

#include <string>
#include <vector>

namespace him {

/// Charge of particles when they appear, per type. A particle that brings a charge of its own keeps it.
class InitialCharges {
public:
    explicit InitialCharges(int types) : rules_(static_cast<std::size_t>(types) + 1) {}

    // All throw std::invalid_argument when the type does not exist, has a rule already, or a number has no meaning.

    void setValue(int type, double charge);  ///< [C]
    /// Normal with that mean and standard deviation [C], by the particle's tag and the seed.
    void setNormal(int type, double mean, const ParticleSpread& spread);
    /// That fraction of the charge 4 pi eps r^2 Gamma at which a particle stops charging at a wall of that type (R17).
    void setEquilibriumFraction(int type, double fraction, int wallType);

    bool any() const { return any_; }
    /// Complains about equilibrium fractions at walls that give no Gamma.
    void check(const ChargingPairs& pairs, Complaints& complaints) const;
    /// Charge [C] of a new particle; 0 for a type without a rule.
    double of(int type, int tag, double radius, const ChargingPairs& pairs, double permittivity) const;
    /// One line per rule.
    std::string describe() const;

private:
    struct Rule {
        bool given = false;
        double mean = 0;       ///< [C]
        ParticleSpread spread;
        double fraction = 0;
        int wallType = 0;      ///< 0: no equilibrium fraction
    };
    Rule& claim(int type);

    std::vector<Rule> rules_;  ///< by type, from 1
    bool any_ = false;
};

}  // namespace him
