// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace him {

/// Throws std::invalid_argument "<what> must be <condition>, found <value>".
[[noreturn]] inline void rejectArgument(const char* what, const char* condition, double value)
{
    std::ostringstream message;
    message << what << " must be " << condition << ", found " << value;
    throw std::invalid_argument(message.str());
}

// The comparisons are quiet: a NaN is refused by the exception, not by a floating point trap.

inline void requirePositive(const char* what, double value)
{
    if (!std::isgreater(value, 0.0) || std::isinf(value)) {
        rejectArgument(what, "> 0 and finite", value);
    }
}

inline void requireNotNegative(const char* what, double value)
{
    if (!std::isgreaterequal(value, 0.0)) {
        rejectArgument(what, ">= 0", value);
    }
}

}  // namespace him
