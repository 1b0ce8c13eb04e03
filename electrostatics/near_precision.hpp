// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace him {

/// Arithmetic of a near sum. In single precision positions are still compared in double; only separations and sums are rounded,
/// to 24 bits, and twice as many pairs are computed at once.
enum class NearPrecision { doublePrecision, singlePrecision };

}  // namespace him
