// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

namespace him {

/// How the velocity of the gas varies inside the cells of its mesh, whose values are their means.
class VelocityProfile {
public:
    virtual ~VelocityProfile() = default;

    /// Makes the profile of these velocities [m/s], one row per local cell. Collective.
    virtual void update(const Points& velocity) = 0;
    /// Velocity at a point [m] of a local cell, less that of the cell [m/s]. Not collective.
    virtual Vector3 deviation(Index cell, const Vector3& point) const = 0;
};

}  // namespace him
