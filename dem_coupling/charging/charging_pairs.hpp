// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/complaints.hpp"
#include "electrostatics/contact_area.hpp"

#include <string>
#include <vector>

namespace him {

/// What counts when a contact that was unloaded grows again.
enum class Reloading {
    counted,       ///< every growth moves charge (A, R, S)
    beyondMaximum  ///< only growth beyond the largest area of this contact
};

/// Charging of one ordered pair of DEM types.
struct ChargingPair {
    bool given = false;        ///< the script said something about this pair
    bool transfers = false;    ///< charge moves
    double transferLimit = 0;  ///< Gamma_ij [V/m]: positive drives charge to the first type; Gamma_ji = -Gamma_ij
    double efficiency = 0;     ///< kappa_c [-]
};

/// The charging laws of a scene, per pair of DEM types (wall materials are types too).
class ChargingPairs {
public:
    explicit ChargingPairs(int types) : types_(types), pairs_(static_cast<std::size_t>(types) * types) {}

    /// Sets both orders of a pair. Throws std::invalid_argument when the pair was given before, a type does not exist,
    /// kappa is negative, a number is not finite, or a type paired with itself has a Gamma other than zero.
    void set(int first, int second, double transferLimit, double efficiency);
    /// No charge moves between these types.
    void setNone(int first, int second);

    int types() const { return types_; }
    const ChargingPair& of(int first, int second) const
    {
        return pairs_[static_cast<std::size_t>(first - 1) * types_ + (second - 1)];
    }

    /// One line per pair of `particleTypes` with itself, another one, or one of `wallTypes`.
    std::string describe() const;
    /// A complaint for every pair that can touch and was not given.
    void complainAboutMissing(const std::vector<int>& particleTypes, const std::vector<int>& wallTypes,
                              const std::string& where, Complaints& complaints) const;

private:
    ChargingPair& at(int first, int second)
    {
        return pairs_[static_cast<std::size_t>(first - 1) * types_ + (second - 1)];
    }
    void claim(int first, int second);

    int types_;
    std::vector<ChargingPair> pairs_;
};

}  // namespace him
