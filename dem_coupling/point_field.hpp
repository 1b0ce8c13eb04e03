// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include <vector>

namespace him {

/// The field at places where no particle's centre is, for `wallField atContactPoint`.
class PointField {
public:
    virtual ~PointField() = default;

    /// Field [V/m] at points, of all charges and their images but those of one particle each, and of outside sources. Collective.
    /// @param sources  this rank's particles: tag, position [m] and charge [C], those that made the field that is held
    /// @param points   of this rank [m], on the surface of the particle that is left out, around its position in `sources`
    /// @param leftOut  tag of the particle that does not act on each point
    /// @param field    one row per point
    virtual void fieldOfOthers(const DemParticles& sources, const Points& points, const std::vector<int>& leftOut,
                               Points& field) = 0;
};

/// A DEM that charges particles with the field at contact points with walls, when its script says so. Beside DemPort.
class PointFieldUser {
public:
    virtual ~PointFieldUser() = default;

    /// Whether the script asks for it.
    virtual bool usesPointField() const = 0;
    /// Before the first field; outlives the DEM's runs.
    virtual void setPointField(PointField& field) = 0;
};

}  // namespace him
