// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/parameters/measured.hpp"

#include <vector>

namespace him {

/// Charge of a sphere over many equal wall contacts: q_n = q_sat + (q_0 - q_sat) exp(-n y). y is M of one contact when the
/// law is `updated`, and -ln(1 - M) when it is `frozen`.
struct SaturationFit {
    Measured saturationCharge;  ///< q_sat [C]
    Measured initialCharge;     ///< q_0 [C]
    Measured decay;             ///< y [-] per contact
    double residual = 0;        ///< root of the mean squared deviation [C]
};

/// Least squares over readings of a charge after some contacts, as a reciprocating charger takes them (R section 4.1.1).
/// The intervals are those of 95 % of a normal distribution, from the scatter of the readings about the curve.
/// @param contacts  numbers of contacts before the readings
/// @param charges   readings [C]
/// Throws std::invalid_argument for fewer than four readings, for lists of different lengths, for contact numbers that do not
/// increase, and when the readings do not bend: then they hold no saturation charge.
SaturationFit fitSaturation(const std::vector<double>& contacts, const std::vector<double>& charges);

}  // namespace him
