// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

namespace him {

/// A measured quantity: its average and the ends of its 95 % interval. An exact one has all three equal.
struct Measured {
    double value = 0;
    double lower = 0;
    double upper = 0;

    static Measured exact(double value) { return {value, value, value}; }
    bool isExact() const { return lower == upper; }
};

/// A quantity computed from measured ones.
struct Estimate {
    double value = 0;    ///< at the averages of the inputs
    double lower95 = 0;  ///< ends of the 95 % interval
    double upper95 = 0;
    double minimum = 0;  ///< extremes over the ends of the inputs' intervals (R section 2.2)
    double maximum = 0;
};

using Formula = std::function<double(const std::vector<double>&)>;

/// Most inputs with an interval that `estimate` takes; their 2^n combinations are all tried.
constexpr std::size_t mostUncertainInputs = 12;

/// Carries the intervals of independent inputs through a formula.
///
/// Minimum and maximum are those over all combinations of the inputs' ends, which are the true extremes of a formula that is
/// monotonic in every input. The 95 % interval adds the effects of the single inputs in quadrature, each side by itself:
/// upper95 = value + sqrt(sum of the squared rises), where input k alone is at the end that raises the formula.
/// @param formula  takes one number per input, in their order
/// Throws std::invalid_argument for more than mostUncertainInputs uncertain inputs; what the formula throws passes through.
Estimate estimate(const std::vector<Measured>& inputs, const Formula& formula);

}  // namespace him
