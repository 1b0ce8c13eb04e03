// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/accuracy_choice.hpp"

#include <array>
#include <limits>
#include <stdexcept>
#include <string>

namespace him {

namespace {

struct Measured {
    double cloudCells;
    PolynomialOrder gather;
    bool deferredCorrection;
    double error;  ///< worst scene, rounded up
};

/// Cheapest first. Worst scenes: dense +-q on cells of one diameter (.053, .011, .0037), a cylinder (.046, .011, .0047), +-q
/// in a polyhedral box (.037, .009, .0034; six cells .0011).
constexpr std::array<Measured, 4> table{{{2, PolynomialOrder::cubic, false, 0.055},
                                         {3, PolynomialOrder::quartic, true, 0.012},
                                         {4, PolynomialOrder::quartic, true, 0.005},
                                         {6, PolynomialOrder::quartic, true, 0.0012}}};

}  // namespace

double smallestAccuracy()
{
    return table.back().error;
}

AccuracyChoice chooseForAccuracy(double accuracy)
{
    for (const Measured& row : table) {
        if (row.error <= accuracy) {
            AccuracyChoice choice;
            choice.p3m.cloudCells = row.cloudCells;
            choice.p3m.gather = row.gather;
            choice.p3m.deferredCorrection = row.deferredCorrection;
            choice.expected = row.error;
            return choice;
        }
    }
    throw std::invalid_argument("chooseForAccuracy: accuracy " + std::to_string(accuracy) + " must be at least "
                                + std::to_string(smallestAccuracy()));
}

double expectedError(const FieldSettings& settings)
{
    double error = std::numeric_limits<double>::quiet_NaN();
    const P3mSettings& p3m = settings.p3m;
    if (settings.method != "p3m" || p3m.cloudRadius > 0) {
        return error;
    }
    for (const Measured& row : table) {
        const bool gatherReaches = row.gather == PolynomialOrder::cubic || p3m.gather == PolynomialOrder::quartic;
        const bool corrected = p3m.deferredCorrection || !row.deferredCorrection;
        if (p3m.cloudCells >= row.cloudCells && gatherReaches && corrected) {
            error = row.error;
        }
    }
    return error;
}

}  // namespace him
