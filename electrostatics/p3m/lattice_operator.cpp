// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/lattice_operator.hpp"

#include <cmath>

namespace him {

double secondDifferenceSymbol(double theta)
{
    const double half = std::sin(0.5 * theta);
    return 4 * half * half;
}

double matchedSymbol(double theta)
{
    constexpr double matching = 0.02;
    const double second = secondDifferenceSymbol(theta);
    const double fourth = second + second * second / 12;  // (30 - 32 cos + 2 cos 2 theta)/12 without cancellation
    return fourth * (1 - matching * second * second);
}

}  // namespace him
