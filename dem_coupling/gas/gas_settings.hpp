// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <string>
#include <vector>

namespace him {

/// Who carries the pressure gradient: gas and particles by their shares (A), or the gas alone (B, S2.4).
enum class PressureModel { modelA, modelB };

/// How a particle's volume, drag and impulse are laid on cells, and the gas gathered from them.
enum class VoidFractionModel {
    centre,   ///< all to the cell that holds the centre
    divided,  ///< by sub-points of equal weight
    smoothed  ///< centre, then diffusion over a length
};

/// Names of the models, in the order of the enumeration.
inline const std::vector<std::string>& voidFractionModelNames()
{
    static const std::vector<std::string> names{"centre", "divided", "smoothed"};
    return names;
}

/// Which velocity of the gas a particle feels.
enum class VelocityInterpolation {
    cell,      ///< that of its cell
    cellPoint  ///< linear between the centre and the points of its cell
};

/// Names of the interpolations, in the order of the enumeration.
inline const std::vector<std::string>& velocityInterpolationNames()
{
    static const std::vector<std::string> names{"cell", "cellPoint"};
    return names;
}

struct GasSettings {
    double density = 0;                 ///< [kg/m3]
    double viscosity = 0;               ///< dynamic [Pa s]
    Vector3 gravity = Vector3::Zero();  ///< for the buoyancy of particles [m/s2]
    PressureModel pressure = PressureModel::modelA;
    std::string drag;  ///< see dragLawNames()
    VoidFractionModel voidFraction = VoidFractionModel::centre;
    double smoothingLength = 0;         ///< of smoothed [m]
    double smallestVoidFraction = 0.1;  ///< cells below are set to it, counted and reported [-]
    VelocityInterpolation velocity = VelocityInterpolation::cell;
    bool particlesOutsideAllowed = false;  ///< else one outside the mesh stops the run
    double virtualMass = 0;                ///< added mass over the mass of the displaced gas; 0.5 for a sphere [-]
    bool saffmanLift = false;

    /// Whether particles feel the acceleration and the vorticity of the gas.
    bool needsGasMotion() const { return virtualMass > 0 || saffmanLift; }
};

}  // namespace him
