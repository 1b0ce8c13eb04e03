// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/size_law.hpp"

#include "electrostatics/require.hpp"

#include <algorithm>
#include <set>

namespace him {

double SizeLaw::transferLimit(double radius) const
{
    requirePositive("radius", radius);
    return planeField + surfacePotential / radius;
}

SizeLaw fitSizeLaw(const std::vector<double>& radii, const std::vector<double>& transferLimits)
{
    if (radii.size() != transferLimits.size()) {
        throw std::invalid_argument("the size law needs one Gamma per radius");
    }
    const std::set<double> different(radii.begin(), radii.end());
    if (different.size() < 2) {
        rejectArgument("number of different radii of the size law", "2 or more", static_cast<double>(different.size()));
    }
    const auto count = static_cast<double>(radii.size());
    double meanCurvature = 0;
    double meanLimit = 0;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        requirePositive("radius", radii[k]);
        meanCurvature += 1.0 / radii[k] / count;
        meanLimit += transferLimits[k] / count;
    }
    double covariance = 0;
    double variance = 0;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const double offset = 1.0 / radii[k] - meanCurvature;
        covariance += offset * (transferLimits[k] - meanLimit);
        variance += offset * offset;
    }
    const double slope = covariance / variance;
    return {meanLimit - slope * meanCurvature, slope};
}

Estimate predictedTransferLimit(const std::vector<SizePoint>& sizes, double radius)
{
    std::vector<double> radii;
    std::vector<double> minima;
    std::vector<double> maxima;
    std::vector<Measured> limits;
    for (const SizePoint& size : sizes) {
        radii.push_back(size.radius);
        minima.push_back(size.transferLimit.minimum);
        maxima.push_back(size.transferLimit.maximum);
        limits.push_back({size.transferLimit.value, size.transferLimit.lower95, size.transferLimit.upper95});
    }
    const auto predicted = [&](const std::vector<double>& y) { return fitSizeLaw(radii, y).transferLimit(radius); };
    Estimate result;
    std::vector<double> averages;
    for (const Measured& limit : limits) {
        averages.push_back(limit.value);
    }
    result.value = predicted(averages);
    double fall = 0;
    double rise = 0;
    for (std::size_t k = 0; k < limits.size(); ++k) {
        for (const double end : {limits[k].lower, limits[k].upper}) {
            std::vector<double> moved = averages;
            moved[k] = end;
            const double change = predicted(moved) - result.value;
            (change < 0 ? fall : rise) = std::hypot(change < 0 ? fall : rise, change);
        }
    }
    result.lower95 = result.value - fall;
    result.upper95 = result.value + rise;
    const double low = predicted(minima);
    const double high = predicted(maxima);
    result.minimum = std::min({low, high, result.value});
    result.maximum = std::max({low, high, result.value});
    return result;
}

Estimate predictedEfficiency(const std::vector<Estimate>& efficiencies)
{
    requirePositive("number of efficiencies", static_cast<double>(efficiencies.size()));
    const auto count = static_cast<double>(efficiencies.size());
    Estimate mean;
    double fall = 0;
    double rise = 0;
    for (const Estimate& one : efficiencies) {
        mean.value += one.value / count;
        mean.minimum += one.minimum / count;
        mean.maximum += one.maximum / count;
        fall = std::hypot(fall, (one.value - one.lower95) / count);
        rise = std::hypot(rise, (one.upper95 - one.value) / count);
    }
    mean.lower95 = mean.value - fall;
    mean.upper95 = mean.value + rise;
    return mean;
}

}  // namespace him
