// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace him {

constexpr double pi = 3.14159265358979323846;

/// Permittivity of free space [F/m] (CODATA 2018).
constexpr double epsilon0 = 8.8541878128e-12;

/// Elementary charge [C] (exact, SI 2019).
constexpr double elementaryCharge = 1.602176634e-19;

}  // namespace him
