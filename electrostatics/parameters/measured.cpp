// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/measured.hpp"

#include "electrostatics/require.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

std::vector<std::size_t> uncertain(const std::vector<Measured>& inputs)
{
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        if (!inputs[k].isExact()) {
            found.push_back(k);
        }
    }
    if (found.size() > mostUncertainInputs) {
        rejectArgument("number of inputs with an interval", "at most 12", static_cast<double>(found.size()));
    }
    return found;
}

}  // namespace

Estimate estimate(const std::vector<Measured>& inputs, const Formula& formula)
{
    const std::vector<std::size_t> varied = uncertain(inputs);
    std::vector<double> averages;
    for (const Measured& input : inputs) {
        averages.push_back(input.value);
    }
    Estimate result;
    result.value = formula(averages);
    result.minimum = result.maximum = result.value;

    double fall = 0;
    double rise = 0;
    for (const std::size_t k : varied) {
        std::vector<double> point = averages;
        point[k] = inputs[k].lower;
        const double atLower = formula(point) - result.value;
        point[k] = inputs[k].upper;
        const double atUpper = formula(point) - result.value;
        fall = std::hypot(fall, std::min({0.0, atLower, atUpper}));
        rise = std::hypot(rise, std::max({0.0, atLower, atUpper}));
    }
    result.lower95 = result.value - fall;
    result.upper95 = result.value + rise;

    for (std::size_t corner = 0; corner < (std::size_t(1) << varied.size()); ++corner) {
        std::vector<double> point = averages;
        for (std::size_t bit = 0; bit < varied.size(); ++bit) {
            const Measured& input = inputs[varied[bit]];
            point[varied[bit]] = (corner >> bit) & 1 ? input.upper : input.lower;
        }
        const double there = formula(point);
        result.minimum = std::min(result.minimum, there);
        result.maximum = std::max(result.maximum, there);
    }
    return result;
}

}  // namespace him
