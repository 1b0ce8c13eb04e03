// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace him {

/// Charge [C] at which a sphere's own field stops charging at an uncharged, unpolarised wall: pi eps d^2 Gamma. \eq S2.14
/// Throws std::invalid_argument when diameter or permittivity is not positive.
/// @param transferLimit  Gamma of the sphere against the wall [V/m]; its sign is that of the charge
/// @param diameter       d of the sphere [m]
/// @param permittivity   eps of the gas [F/m]
double equilibriumCharge(double transferLimit, double diameter, double permittivity);

/// Ratio e/g [-] of the Coulomb force between two touching spheres with the charge to the weight of one. \eq S2.15
/// Throws std::invalid_argument when diameter, permittivity, mass or gravity is not positive.
/// @param charge   of each sphere [C]
/// @param mass     of one sphere [kg]
/// @param gravity  [m/s2], positive
double forceOverWeight(double charge, double diameter, double permittivity, double mass, double gravity);

/// The Gamma [V/m], not negative, whose equilibrium charge gives this e/g (S2.14 in S2.15).
double transferLimitFor(double forceOverWeight, double diameter, double permittivity, double mass, double gravity);

}  // namespace him
