// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/pair_kernels.hpp"
#include "electrostatics/types.hpp"

#include <cmath>
#include <string>

namespace him {

/// Throws std::domain_error "the <what> of row <row> must be finite (at most 1e50), found <value>".
[[noreturn]] void throwNotFinite(const char* what, Index row, double value);

/// "(x y z) m" with up to 10 digits.
std::string pointText(const Vector3& point);

/// Refuses NaN, infinity and anything whose powers would overflow. The comparison is quiet.
inline void requireFinite(const char* what, Index row, double value)
{
    if (!std::islessequal(std::abs(value), largestCoordinate)) {
        throwNotFinite(what, row, value);
    }
}

/// Looks for a source at the same position as a target, by brute force, and throws std::domain_error naming both rows if
/// there is one.
/// @param selfRow  row of the target among the sources, or -1
void refuseSharedPosition(const Points& targets, Index target, const Points& sources, Index selfRow);

}  // namespace him
