// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace him {

/// The compact charge cloud g(r) = c (1 - u^2)^k, u = r/R < 1, of a unit charge: what the mesh sees of a particle. Inside,
/// density, field and potential are polynomials in u^2; from R on the cloud is a point charge to the outside (Gauss), so
/// that a pair sum of the short-range part, which vanishes there, completes the mesh to Coulomb's law.
/// Distances r >= 0 [m]. Factors of 1/(4 pi eps) are left out of field and potential.
class ChargeCloud {
public:
    /// @param radius    R in 1e-40..1e50 [m]
    /// @param exponent  k = 1 or 2. Throws std::invalid_argument otherwise.
    ChargeCloud(double radius, int exponent);

    double radius() const { return radius_; }
    int exponent() const { return exponent_; }

    double density(double r) const;  ///< g [1/m3], zero from R on
    double
    fieldCoefficient(double r) const;  ///< F [1/m3]: the field of the cloud is F times the vector from its centre
    double potential(double r) const;  ///< psi [1/m]

    /// s = 1/r - psi [1/m], zero from R on; r > 0.
    double shortRangePotential(double r) const;
    /// 1/r^3 - F [1/m3], zero from R on; r > 0.
    double shortRangeFieldCoefficient(double r) const;

    /// The polynomials inside, for loops over pairs: psi = sum potential[n] u^2n, F = sum field[n] u^2n. Trailing
    /// coefficients that an exponent does not need are zero.
    struct Coefficients {
        double inverseSquaredRadius;      ///< [1/m2]
        std::array<double, 4> potential;  ///< [1/m]
        std::array<double, 3> field;      ///< [1/m3]
    };
    const Coefficients& coefficients() const { return coefficients_; }

private:
    double radius_;
    int exponent_;
    double centreDensity_;  ///< c [1/m3]
    Coefficients coefficients_;
};

}  // namespace him
