// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/statistics/saturation_curve.hpp"

#include <cstddef>
#include <vector>

namespace him {

/// The saturation curve (S6.1) of a run that is still going on. Keeps at most `mostValues` values, evenly spread in their order:
/// when they are full, every second one goes and from then on every second one comes in. The fit is made anew when the number of
/// values that were offered has grown by a twentieth, so that a whole run costs a few hundred fits, however long it is.
class RunningSaturation {
public:
    static constexpr std::size_t mostValues = 400;

    /// @param chargingTime  a t [s], growing; values at 0 and before are left out
    /// @param value         Q or Q/M at that time
    void add(double chargingTime, double value);
    /// The last fit made, with tau of a = 1.
    const SaturationCurve& curve() const { return curve_; }
    std::size_t values() const { return values_.size(); }

private:
    std::vector<double> times_, values_;
    std::size_t offered_ = 0;
    std::size_t stride_ = 1;
    std::size_t nextFit_ = 3;
    SaturationCurve curve_;
};

}  // namespace him
