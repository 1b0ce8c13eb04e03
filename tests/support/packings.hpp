// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <cstdint>

namespace him {

/// Standard scenes of hard spheres in a cube, on which field methods are compared.
enum class Scene {
    dilute,  ///< 1 % of the volume, at random
    bed,     ///< 55 % of the lower half, disordered
    layer    ///< spheres that touch the six walls and cover 40 % of them, a rim of one diameter left free
};
enum class Signs {
    like,   ///< all +q
    random  ///< +q or -q with equal chance
};

struct Packing {
    Box box;  ///< from the origin
    double diameter = 0;
    Points position;
    Scalars charge;
};

/// The same for the same arguments on every machine. On one core 0.1 s (dilute, 84), 1.7 s (bed, 24).
/// @param length    side of the cube in diameters, at least 6; a bed needs about 10
/// @param diameter  of the spheres [m]
/// @param charge    q [C]
/// Throws std::runtime_error when the spheres do not fit.
Packing makePacking(Scene scene, double length, Signs signs, std::uint32_t seed = 1, double diameter = 1,
                    double charge = 1);

}  // namespace him
