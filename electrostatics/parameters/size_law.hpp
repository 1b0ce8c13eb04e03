// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/parameters/measured.hpp"

#include <vector>

namespace him {

/// How Gamma at a wall depends on the size of the sphere (R19, Cruise et al., in its right form):
/// Gamma = sigma_f/epsilon0 + Phi_sat/r.
struct SizeLaw {
    double planeField = 0;        ///< sigma_f/epsilon0 [V/m]: Gamma of an infinitely large sphere
    double surfacePotential = 0;  ///< Phi_sat [V]: potential of the surface at saturation

    /// Gamma [V/m] of a sphere of that radius [m].
    double transferLimit(double radius) const;
};

/// Least squares over 1/r; exact for two sizes.
/// @param radii           [m]
/// @param transferLimits  Gamma [V/m], one per radius
/// Throws std::invalid_argument for fewer than two different radii or a radius that is not positive.
SizeLaw fitSizeLaw(const std::vector<double>& radii, const std::vector<double>& transferLimits);

/// Gamma of one size, with intervals.
struct SizePoint {
    double radius = 0;       ///< [m]
    Estimate transferLimit;  ///< [V/m]
};

/// Gamma [V/m] that the law through these sizes predicts for another radius. Minimum and maximum come from the laws through
/// all minima and through all maxima, as R's Table 6; the 95 % interval adds the sizes' intervals in quadrature.
Estimate predictedTransferLimit(const std::vector<SizePoint>& sizes, double radius);

/// kappa_c [-] of another size: the mean over the sizes, as R's Table 6, for kappa_c does not depend on size. Minimum and
/// maximum are the means of the minima and of the maxima. Throws std::invalid_argument for an empty list.
Estimate predictedEfficiency(const std::vector<Estimate>& efficiencies);

}  // namespace him
