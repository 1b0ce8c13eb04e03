// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace him {

/// Field [V/m] at the surface of a uniformly charged sphere: q / (4 pi eps r^2), positive outwards.
/// @param permittivity  eps = relativePermittivity * epsilon0 [F/m]
double surfaceField(double charge, double radius, double permittivity);

/// Charge [C] at which an isolated sphere stops charging at a wall (R17): 4 pi eps r^2 Gamma.
double saturationCharge(double transferLimit, double radius, double permittivity);

/// Relaxation number x [-] of one growing contact for a sphere of radius r [m]: kappa a a_corr dA / (4 pi r^2).
/// It is the share of its distance to saturation that the contact would move in an explicit step.
/// @param efficiency  kappa_c times acceleration a times softening correction a_corr [-]
/// @param areaGrowth  dA > 0 [m2]
double relaxationNumber(double efficiency, double areaGrowth, double radius);

/// (1 - exp(-M)) / M for M >= 0, by series below M = 1e-3, so that it tends to 1 without cancellation.
double relaxationFactor(double relaxation);

/// The same for an M that is known to be >= 0. Inline: charging calls it for every contact.
inline double relaxationFactorOf(double relaxation)
{
    constexpr double seriesLimit = 1e-3;  // the first term left out is M^5/720, below the last bit
    if (relaxation < seriesLimit) {
        const double m = relaxation;
        return 1.0 - m / 2.0 * (1.0 - m / 3.0 * (1.0 - m / 4.0 * (1.0 - m / 5.0)));
    }
    return -std::expm1(-relaxation) / relaxation;
}

/// Charge [C] that one volt per metre drives through the grown area, eps kappa a a_corr dA (R16, R28, S2.10), of factors that are known
/// to be positive. Inline: charging calls it for every contact.
inline double conductanceOf(double efficiency, double areaGrowth, double permittivity)
{
    return permittivity * efficiency * areaGrowth;
}

/// One growing contact in the canonical order of its two bodies: a is the particle (the lower tag in a pair), b its
/// partner or the wall; the normal points from a to b.
struct ContactDrive {
    double transferLimit;   ///< Gamma_ab [V/m], positive drives charge to a
    double surfaceFieldA;   ///< q_a / (4 pi eps r_a^2) [V/m]
    double surfaceFieldB;   ///< q_b / (4 pi eps r_b^2) [V/m]; 0 for a wall
    double fieldNormal;     ///< E_other . n_ab [V/m], the field of all other charges
};

/// Charge [C] gained by a in one step of a growing contact; b (or the wall) gets exactly the negative.
///
/// dq = eps kappa a a_corr dA (Gamma - E_a + E_b - E_other.n) (1 - exp(-M))/M        (R16 with R28, shared factor)
///
/// @param relaxation    M = max(Lambda_a + x_b, Lambda_b + x_a) for a pair and Lambda_a for a wall, where Lambda is the
///                      sum of a particle's relaxation numbers over all its growing contacts of this step. Exact for an
///                      isolated contact; several contacts together cannot overshoot.
/// @param efficiency    kappa_c a a_corr [-]
/// @param areaGrowth    dA [m2]; nothing moves when it is not positive
/// @param permittivity  eps [F/m]
double chargeGained(const ContactDrive& drive, double relaxation, double efficiency, double areaGrowth, double permittivity);

/// M of a pair contact, see chargeGained.
double pairRelaxation(double sumA, double sumB, double numberA, double numberB);

/// Charge [C] gained in one step under the `frozen` law (S): the explicit form, without any relaxation. It may
/// overshoot above x = 0.5.
double chargeGainedFrozen(const ContactDrive& drive, double efficiency, double areaGrowth, double permittivity);

}  // namespace him
