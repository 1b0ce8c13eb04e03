// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace him {

/// Q(t) = Q_inf (1 - exp(-a t/tau)). \eq S6.1
struct SaturationCurve {
    double limit = 0;       ///< Q_inf, in the unit of the values
    double timeScale = 0;   ///< tau [s] of a = 1
    double deviation = 0;   ///< root mean square of values less curve, in their unit
    bool known = false;     ///< whether the values bend enough for a fit

    double at(double time, double acceleration) const;
};

/// Least-squares fit through the origin of time. Q_inf follows linearly from tau, so one search over tau is all. `known` is
/// false for fewer than three values, for values that are all zero, and for values that show no bend between a tenth of the
/// shortest and a hundred times the longest time.
/// @param times         since charging began [s]; positive
/// @param acceleration  a of the run [-]
SaturationCurve fitSaturation(const std::vector<double>& times, const std::vector<double>& values, double acceleration);

}  // namespace him
