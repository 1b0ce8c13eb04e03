// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/particle_random.hpp"
#include "dem_coupling/complaints.hpp"
#include "electrostatics/contact_area.hpp"
#include "electrostatics/transfer_limit.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace him {

/// What counts when a contact that was unloaded grows again.
enum class Reloading {
    counted,       ///< every growth moves charge (A, R, S)
    beyondMaximum  ///< only growth beyond the largest area of this contact
};

/// Where Gamma of a pair of types comes from.
enum class LimitLaw {
    given,         ///< a number
    atWall,        ///< saturation of the first type, given with the pair (R17, R19)
    saturations,   ///< difference of the saturations of both types (R18); a type without one counts as a wall
    workFunctions  ///< difference of the work functions of both types (R15)
};

/// Charging of one ordered pair of DEM types.
struct ChargingPair {
    bool given = false;        ///< the script said something about this pair
    bool transfers = false;    ///< charge moves
    double transferLimit = 0;  ///< the part of Gamma_ij without size [V/m]: positive drives charge to the first type
    double efficiency = 0;     ///< kappa_c [-]
    double rate = 0;           ///< kappa_c a a_corr [-]
    LimitLaw law = LimitLaw::given;
    double potentialFirst = 0;  ///< Phi_sat of the first type [V]: Gamma_ij has + Phi/r_i (R19)
    double potentialSecond = 0;
    double softening = 1;       ///< a_corr [-]
    SaturationLaw atWall = {};  ///< of a pair whose law is atWall
    bool leads = true;          ///< atWall is the saturation of the first type, not of the second

    /// Gamma_ij [V/m] of a particle of the first type and one of the second; a wall has an infinite radius.
    double limit(double radiusFirst, double inverseRadiusSecond) const
    {
        if (potentialFirst == 0 && potentialSecond == 0) {
            return transferLimit;  // most pairs: no division
        }
        return transferLimit + potentialFirst / radiusFirst - potentialSecond * inverseRadiusSecond;
    }
};

/// The charging laws of a scene, per pair of DEM types (wall materials are types too).
class ChargingPairs {
public:
    explicit ChargingPairs(int types);

    // --- pairs. All throw std::invalid_argument when the pair was given before, a type does not exist, kappa is negative
    // or a number is not finite.

    /// Sets both orders of a pair. A type paired with itself has Gamma 0, everything else is refused.
    void set(int first, int second, double transferLimit, double efficiency);
    /// Gamma by the saturation of the first type at the second (R17, R19). Refused between equal types.
    void setAtWall(int first, int second, const SaturationLaw& law, double efficiency);
    /// Gamma by the saturations of both types (R18), which setSaturation() gives.
    void setFromSaturations(int first, int second, double efficiency);
    /// Gamma by the work functions of both types (R15), which setWorkFunction() gives.
    void setFromWorkFunctions(int first, int second, double efficiency);
    /// No charge moves between these types.
    void setNone(int first, int second);

    // --- types. All throw std::invalid_argument when the type does not exist, has one already, or the number has no meaning.

    void setSaturation(int type, const SaturationLaw& law);
    void setWorkFunction(int type, double workFunction);  ///< [J]
    /// Gamma_ij of a particle of this type varies with its tag: + deviation * N(0, 1) [V/m], with the opposite sign where the
    /// particle is the second.
    void setSpread(int type, const ParticleSpread& spread);
    /// The same by its work function [J].
    void setWorkFunctionSpread(int type, const ParticleSpread& spread);

    // --- all pairs

    void setSeparation(double separation);                        ///< delta_e of work functions [m]
    void setAcceleration(double acceleration);                    ///< a > 0, multiplies every kappa
    void setSoftening(int first, int second, double correction);  ///< a_corr of both orders
    double acceleration() const { return acceleration_; }
    double separation() const { return separation_; }

    /// What the laws ask for and nobody gave: a work function or saturation, and what was given for nothing. Empty: fine.
    Complaints check() const;
    /// Makes the numbers from the laws. Call after the last set...() and whenever the permittivity [F/m] changes.
    void resolve(double permittivity);

    int types() const { return types_; }
    const ChargingPair& of(int first, int second) const
    {
        return pairs_[static_cast<std::size_t>(first - 1) * types_ + second - 1];
    }
    /// What the spread adds to Gamma of a particle [V/m].
    double spreadOf(int type, int tag) const { return spreads_[static_cast<std::size_t>(type)].of(tag); }
    bool spreads() const { return anySpread_; }
    /// Whether any pair moves charge at all.
    bool transfers() const
    {
        return std::any_of(pairs_.begin(), pairs_.end(), [](const ChargingPair& pair) { return pair.transfers; });
    }

    /// One line per given pair.
    std::string describe() const;
    /// Complains about pairs that can touch and were not given. Particles touch particles and walls.
    void complainAboutMissing(const std::vector<int>& particleTypes, const std::vector<int>& wallTypes,
                              const std::string& where, Complaints& complaints) const;

private:
    struct Material {
        std::optional<SaturationLaw> saturation;
        std::optional<double> workFunction;  ///< [J]
        ParticleSpread spread;               ///< [V/m], or [J]
        bool spreadOfWorkFunction = false;
    };
    ChargingPair& at(int first, int second) { return const_cast<ChargingPair&>(of(first, second)); }
    Material& material(int type, const char* what);
    void claim(int first, int second);
    void transfer(int first, int second, double efficiency, LimitLaw law);
    void resolvePair(int first, int second, double permittivity);
    void describeLaw(int first, int second, std::string& text) const;

    int types_;
    std::vector<ChargingPair> pairs_;
    std::vector<Material> materials_;      ///< by type, from 1
    std::vector<ParticleSpread> spreads_;  ///< by type, from 1 [V/m]
    bool anySpread_ = false;
    double separation_ = defaultChargeSeparation;
    double acceleration_ = 1;
};

}  // namespace him
