// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <array>

namespace him {

/// A polynomial of degree up to 4 around a centre, in the scaled place xi = scale (x - centre). Its monomials are ordered by degree,
/// then by falling powers of x, then of y: x, y, z; x2, xy, xz, y2, yz, z2; x3, x2y, x2z, xy2, xyz, xz2, y3, y2z, yz2, z3; ...
struct LocalPolynomial {
    static constexpr int mostCoefficients = 34;
    static constexpr int paddedCoefficients = 36;  ///< a multiple of the four that are worked on at a time

    Vector3 centre;
    Eigen::Matrix3d scale;  ///< [1/m]
    double value = 0;       ///< at the centre
    std::array<double, paddedCoefficients>
        coefficients{};  ///< of the monomials of degree 1 to `order`, zeros behind them
    int order = 0;

    /// Value and gradient [per metre] at a point.
    void evaluate(const Vector3& x, double& valueThere, Vector3& gradient) const;
};

/// Number of monomials of degree 1 to `order`.
constexpr int coefficientsOf(int order)
{
    return (order + 1) * (order + 2) * (order + 3) / 6 - 1;
}

/// The monomials of degree 1 to `order` at xi, coefficientsOf(order) numbers.
void monomials(const Vector3& xi, int order, double* out);

/// Their derivatives along `direction` at xi.
void derivatives(const Vector3& xi, const Vector3& direction, int order, double* out);

}  // namespace him
