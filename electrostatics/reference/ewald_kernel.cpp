// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/reference/ewald_kernel.hpp"

#include "electrostatics/constants.hpp"

#include <cmath>

namespace him {

EwaldKernel::EwaldKernel(double alpha, double cutoff) : alpha_(alpha), width_(1.0 / 128), perWidth_(128)
{
    // The last interval ends beyond alpha cutoff, whatever the rounding.
    const auto intervals = static_cast<std::size_t>(alpha * cutoff * perWidth_) + 2;
    table_.resize(intervals);
    for (std::size_t interval = 0; interval < intervals; ++interval) {
        const double t = (static_cast<double>(interval) + 0.5) * width_;
        Coefficients& c = table_[interval];
        c[0] = std::erfc(t);
        // The n-th derivative of erfc is (-1)^n 2/sqrt(pi) H_(n-1)(t) exp(-t^2), with Hermite's H_(n+1) = 2 t H_n - 2 n H_(n-1).
        double hermite = 1;
        double previous = 0;
        double factor = -2 / std::sqrt(pi) * std::exp(-t * t);
        for (int n = 1; n <= degree; ++n) {
            factor /= n;
            c[static_cast<std::size_t>(n)] = factor * hermite;
            factor = -factor;
            const double next = 2 * t * hermite - 2 * (n - 1) * previous;
            previous = hermite;
            hermite = next;
        }
    }
}

}  // namespace him
