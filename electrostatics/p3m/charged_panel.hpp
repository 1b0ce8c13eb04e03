// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/field_at_places.hpp"
#include "electrostatics/types.hpp"

#include <array>
#include <vector>

namespace him {

/// A flat triangle or quadrangle with a unit charge spread evenly over it. Factors of 1/(4 pi eps) are left out.
struct ChargedPanel {
    std::array<Vector3, 4> corner;   ///< [m], one after the other around it
    int corners = 0;                 ///< 3 or 4
    Vector3 normal;                  ///< unit, the corners go round it anticlockwise
    std::array<Vector3, 4> along;    ///< unit, from each corner to the next one
    std::array<Vector3, 4> outward;  ///< unit, of the side from each corner to the next one
    Vector3 centre;                  ///< mean of the corners [m]
    double radius = 0;               ///< largest distance of a corner from the centre [m]
    double area = 0;                 ///< [m2]

    /// Adds field and potential at some places, to round-off (Wilton et al. 1984, IEEE Trans. Antennas Propag. 32(3),
    /// 276-281, eqs. 5 and 6). In the plane of the panel the normal field is the mean of both sides, zero; on an edge it is
    /// not finite. The solid angle is that of van Oosterom and Strackee (1983, IEEE Trans. Biomed. Eng. 30(2), 125-126).
    /// @param factor  charge of the panel; what is added is this times the field of a unit charge
    void addField(double factor, FieldAtPlaces& at) const;

    /// Gauss points that stand for the panel, 4 in a quadrangle and 3 in a triangle. Their shares add up to 1; their moments are
    /// the panel's, up to the third degree in a parallelogram and to the second in a triangle.
    struct Point {
        Vector3 position;  ///< [m]
        double share;      ///< of the charge
    };
    std::vector<Point> points() const;
};

/// Adds the Coulomb field and potential of the points() of a panel of charge `factor`.
void addFieldOfPoints(const std::vector<ChargedPanel::Point>& points, double factor, FieldAtPlaces& at);

/// The panel with these corners [m], of which a triangle has three.
ChargedPanel panelWith(const std::array<Vector3, 4>& corner, int corners);

/// A polygon cut into panels: flat quadrangles into pieces with sides of at most `longest` [m], other polygons into triangles
/// around their centre.
std::vector<ChargedPanel> panelsOf(const std::vector<Vector3>& polygon, double longest);

}  // namespace him
