// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/statistics/saturation_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace him {

namespace {

constexpr int scanPoints = 200;
constexpr int refinements = 200;

struct Trial {
    double limit = 0;
    double squares = std::numeric_limits<double>::infinity();
};

/// Best Q_inf and the sum of squared deviations for a given rate [1/s].
Trial tryRate(const std::vector<double>& times, const std::vector<double>& values, double rate)
{
    double fq = 0, ff = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        const double f = -std::expm1(-rate * times[n]);
        fq += f * values[n];
        ff += f * f;
    }
    Trial trial;
    trial.limit = fq / ff;
    trial.squares = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        const double off = values[n] + trial.limit * std::expm1(-rate * times[n]);
        trial.squares += off * off;
    }
    return trial;
}

}  // namespace

SaturationCurve fitSaturationCurve(const std::vector<double>& times, const std::vector<double>& values)
{
    if (times.size() != values.size()) {
        throw std::invalid_argument("a saturation curve needs one value per time");
    }
    if (std::any_of(times.begin(), times.end(), [](double time) { return !(time > 0); })) {
        throw std::invalid_argument("a saturation curve needs positive times");
    }
    SaturationCurve curve;
    const bool nothing = std::all_of(values.begin(), values.end(), [](double value) { return value == 0; });
    if (times.size() < 3 || nothing) {
        return curve;
    }
    const double slowest = 0.01 / *std::max_element(times.begin(), times.end());
    const double fastest =
        10 / *std::min_element(times.begin(), times.end());  // beyond it the first value is Q_inf to 5e-5
    const double step = std::log(fastest / slowest) / scanPoints;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int n = 0; n <= scanPoints; ++n) {
        const double squares = tryRate(times, values, slowest * std::exp(n * step)).squares;
        if (squares < least) {
            least = squares;
            best = n;
        }
    }
    if (best == 0 || best == scanPoints) {
        return curve;
    }
    // Golden section between the neighbours of the best point.
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    double low = (best - 1) * step, high = (best + 1) * step;
    const auto squaresAt = [&](double x) { return tryRate(times, values, slowest * std::exp(x)).squares; };
    for (int n = 0; n < refinements && high - low > 1e-14; ++n) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (squaresAt(a) < squaresAt(b) ? high : low) = squaresAt(a) < squaresAt(b) ? b : a;
    }
    const double rate = slowest * std::exp(0.5 * (low + high));
    const Trial trial = tryRate(times, values, rate);
    curve.limit = trial.limit;
    curve.timeScale = 1 / rate;
    curve.deviation = std::sqrt(trial.squares / static_cast<double>(times.size()));
    curve.known = true;
    return curve;
}

}  // namespace him
