// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace him {

/// Short-range part of a charge whose Gaussian cloud is handled by modes: erfc(alpha r)/r and its field, from a table of
/// Taylor expansions of erfc, exact to 1e-15 of the value at r = 0+ times r.
class EwaldKernel {
public:
    /// @param alpha   splitting parameter [1/m]
    /// @param cutoff  largest distance asked for [m]
    EwaldKernel(double alpha, double cutoff);

    /// `potential` = erfc(alpha r)/r and `field` = (erfc(alpha r)/r + 2 alpha/sqrt(pi) exp(-(alpha r)^2))/r^2, so that the
    /// field of a unit charge is `field` times the vector from it. 0 < r <= cutoff.
    void evaluate(double r, double& potential, double& field) const
    {
        const double t = alpha_ * r;
        const double position = t * perWidth_;
        const auto interval = static_cast<std::size_t>(position);
        const Coefficients& c = table_[interval];
        const double u = (position - static_cast<double>(interval) - 0.5) * width_;
        double value = c[degree];
        double slope = 0;
        for (int n = degree - 1; n >= 0; --n) {
            slope = slope * u + value;
            value = value * u + c[static_cast<std::size_t>(n)];
        }
        const double inverse = 1 / r;
        potential = value * inverse;
        field = (potential - alpha_ * slope) * inverse * inverse;
    }

    double alpha() const { return alpha_; }

private:
    static constexpr int degree = 6;
    using Coefficients = std::array<double, degree + 1>;
    double alpha_, width_, perWidth_;
    std::vector<Coefficients> table_;
};

}  // namespace him
