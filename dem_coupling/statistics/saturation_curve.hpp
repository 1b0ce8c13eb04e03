// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace him {

/// Q(t) = Q_inf (1 - exp(-a t/tau)). \eq S6.1
struct SaturationCurve {
    double limit = 0;      ///< Q_inf, in the unit of the values
    double timeScale = 0;  ///< tau/a in the unit of the times
    double deviation = 0;  ///< root mean square of values less curve, in their unit
    bool known = false;    ///< whether the values bend enough for a fit
};

/// Least-squares fit through the origin of time. Q_inf follows linearly from tau, so one search over tau is all. `known` is
/// false for fewer than three values, for values that are all zero, and for values that show no bend between a tenth of the
/// shortest and a hundred times the longest time. Throws std::invalid_argument unless there is one value per time.
/// @param times  t since charging began [s], or a t, for a tau of a = 1; positive
SaturationCurve fitSaturationCurve(const std::vector<double>& times, const std::vector<double>& values);

}  // namespace him
