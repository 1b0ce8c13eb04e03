// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/reference/grounded_sphere.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/require.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace him {

void computeInGroundedSphere(const Vector3& centre, double radius, double permittivity, const Points& position,
                             const Scalars& charge, Points& field, Scalars& potential)
{
    requirePositive("radius of the sphere", radius);
    field.setZero(position.rows(), 3);
    potential.setZero(position.rows());
    addAllPairs(position, position, charge, 0, permittivity, field, potential);  // checks what is finite

    // In units of the radius. The image of a charge at s seen from x makes -q/sqrt(D), D = x^2 s^2 - 2 x.s + 1, which has no
    // singularity for a charge at the centre.
    const Points place = (position.rowwise() - centre.transpose().array()) / radius;
    const Scalars square = place.square().rowwise().sum();
    for (Index row = 0; row < place.rows(); ++row) {
        if (square[row] >= 1) {
            std::ostringstream text;
            text << "the position of row " << row << ", " << pointText(position.row(row).matrix())
                 << ", is not inside the sphere of radius " << radius << " m around " << pointText(centre);
            throw std::domain_error(text.str());
        }
    }
    const double coulombConstant = 1 / (4 * pi * permittivity);
    for (Index row = 0; row < place.rows(); ++row) {
        const Scalars product =
            place.col(0) * place(row, 0) + place.col(1) * place(row, 1) + place.col(2) * place(row, 2);
        const Scalars inverse = (square * square[row] - 2 * product + 1).rsqrt();
        potential[row] -= coulombConstant / radius * (charge * inverse).sum();
        const Scalars weight = coulombConstant / (radius * radius) * charge * inverse.cube();
        for (int axis = 0; axis < 3; ++axis) {
            field(row, axis) -= (weight * (square * place(row, axis) - place.col(axis))).sum();
        }
    }
}

}  // namespace him
