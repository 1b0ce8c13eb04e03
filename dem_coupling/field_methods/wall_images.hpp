// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/field_settings.hpp"

#include <vector>

namespace him {

/// Images of charges in grounded walls, as Rasera et al. 2022 section 2.4 make them: every charge is mirrored in every plane, in the edges
/// of two perpendicular planes and in the corners of three, with alternating sign; in a cylinder in the tangent plane of the
/// nearest point of its wall. Images of images between parallel planes are left out.
class WallImages {
public:
    explicit WallImages(std::vector<ImageWall> walls) : walls_(std::move(walls)) {}

    /// Images of all charges. Row n of the result belongs to charge owner[n].
    struct Set {
        Points position;  ///< [m]
        Scalars charge;   ///< [C]
        std::vector<Index> owner;
    };
    void make(const Points& position, const Scalars& charge, Set& images) const;
    /// Coulomb field [V/m] of every particle's own images, those within `reach` [m], per row.
    void ownField(const DemParticles& particles, double permittivity, double reach, Points& field) const;
    bool empty() const { return walls_.empty(); }

private:
    std::vector<ImageWall> walls_;
};

}  // namespace him
