// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace him {

/// Which contact area the charging law sees. `hertz` is A = pi r* delta (R, text after R15); `doubled` is
/// A = 2 pi r* delta (S2.11).
enum class AreaLaw { hertz, doubled };

/// The law of that name. Throws std::invalid_argument that lists the known names.
AreaLaw areaLawByName(const std::string& name);
std::string nameOf(AreaLaw law);

/// Effective contact radius r* [m] of two spheres (R5). Symmetric in its arguments to the last bit.
double effectiveRadius(double radiusA, double radiusB);

/// Contact area [m2] at the overlap delta [m] (>= 0) and the effective radius r* [m].
double contactArea(AreaLaw law, double effectiveRadius, double overlap);

/// Largest overlap [m] of an elastic Hertz impact: delta = (15 m* v^2 / (16 Y* sqrt(r*)))^(2/5).
/// @param effectiveMass     m* [kg]
/// @param effectiveModulus  Y* [Pa] (R6)
/// @param effectiveRadius   r* [m]
/// @param normalSpeed       v [m/s]
double hertzImpactOverlap(double effectiveMass, double effectiveModulus, double effectiveRadius, double normalSpeed);

/// Contact time [s] of an elastic Hertz impact: 2.94328 delta_max / v.
double hertzImpactTime(double maximumOverlap, double normalSpeed);

/// Largest contact area [m2] of a sphere that hits a rigid flat (R25), area law `hertz`.
double impactAreaOnRigidFlat(double radius, double density, double youngsModulus, double poissonRatio, double normalSpeed);

/// Rayleigh time step [s] of a sphere (R13): pi r sqrt(rho/G)/(0.1631 nu + 0.8766), G = Y/(2 (1 + nu)).
/// @param density  rho [kg/m3]
double rayleighTimeStep(double radius, double density, double youngsModulus, double poissonRatio);

/// Correction a_corr [-] for softened moduli (S2.12): (Y*_soft / Y*_real)^(2/5). Right for impacts only; resting
/// contacts would scale with the power 2/3.
double softeningCorrection(double softModulus, double realModulus);

}  // namespace him
