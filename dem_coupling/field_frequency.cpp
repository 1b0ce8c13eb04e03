// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_frequency.hpp"

#include <algorithm>
#include <cmath>

namespace him {

double fieldFrequency(const DemParticles& particles, const Points& field)
{
    double largest = 0;
    for (Index row = 0; row < particles.size(); ++row) {
        const double force = particles.charge[row] * std::sqrt(field.row(row).square().sum());
        largest = std::max(largest, std::fabs(force) / (particles.mass[row] * particles.radius[row]));
    }
    return std::sqrt(2 * largest);
}

double heldFieldFrequency(const DemParticles& particles, const Points& heldField, double reach, double cloudGradient,
                          double largestCharge)
{
    double largest = 0;
    for (Index row = 0; row < particles.size(); ++row) {
        const double strength = std::sqrt(heldField.row(row).square().sum());
        const double gradient = cloudGradient * largestCharge + strength / reach;
        largest = std::max(largest, std::fabs(particles.charge[row]) * gradient / particles.mass[row]);
    }
    return std::sqrt(2 * largest);
}

}  // namespace him
