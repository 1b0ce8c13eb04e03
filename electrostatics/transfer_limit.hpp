// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace him {

/// The laws of the charge transfer limit Gamma_ij [V/m]. A positive one charges i positively; Gamma_ij = -Gamma_ji.

/// How a material saturates at a wall: the surface charge density of a large sphere and what small spheres have more.
/// Its own Gamma is density/eps + potential/r (R19 in its right form; R17 when `potential` is 0).
struct SaturationLaw {
    double density = 0;    ///< sigma_f [C/m2]
    double potential = 0;  ///< Phi_sat [V]
};

/// The law of a sphere that saturates at charge [C] with that radius [m] (R17): density q/(4 pi r^2), whatever the size.
/// Throws std::invalid_argument unless the radius is positive.
SaturationLaw saturationOfSphere(double charge, double radius);

/// Gamma [V/m] of a sphere of that radius [m] at a wall (R19, R17). Throws std::invalid_argument unless radius and
/// permittivity [F/m] are positive.
double transferLimitAtWall(const SaturationLaw& law, double radius, double permittivity);

/// Gamma_ij [V/m] of two spheres (R18 with the densities at their own sizes): (sigma_i - sigma_j)/eps.
double transferLimitOfSpheres(const SaturationLaw& lawI, double radiusI, const SaturationLaw& lawJ, double radiusJ,
                              double permittivity);

/// Gamma_ij [V/m] from work functions [J] (R15, S2.10): (phi_j - phi_i)/(delta_e e). The body of the higher work function
/// charges negatively. Throws std::invalid_argument unless delta_e [m] and both work functions are positive.
double transferLimitOfWorkFunctions(double workFunctionI, double workFunctionJ, double separation);

/// delta_e [m] where nothing else is said (S, page of enable_electric_field).
constexpr double defaultChargeSeparation = 500e-9;

}  // namespace him
