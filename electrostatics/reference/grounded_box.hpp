// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/reference/box_axis.hpp"
#include "electrostatics/types.hpp"

#include <array>
#include <vector>

namespace him {

/// Conditions on the six sides of a box; grounded everywhere unless said otherwise.
struct BoxSides {
    std::array<BoxSide, 3> lower{BoxSide::grounded, BoxSide::grounded, BoxSide::grounded};
    std::array<BoxSide, 3> upper{BoxSide::grounded, BoxSide::grounded, BoxSide::grounded};
};

/// Exact field of point charges in a rectangular grounded box, all images included: Ewald's sum in which the smooth part is
/// expanded in the box's own modes (sine modes between grounded sides: the periodic box of 8 sign-alternating images with an
/// eighth of its charges and waves). For reference, not for speed: the cost grows like N^1.5. Sides may be insulated
/// (cosine modes) or periodic instead; without a grounded side a uniform background takes up the net charge, and the mean
/// potential is zero.
class GroundedBox {
public:
    /// @param permittivity  eps [F/m]. Throws std::invalid_argument when the box is empty or eps is not positive.
    GroundedBox(const Box& box, double permittivity, const BoxSides& sides = {});

    /// What Ewald's sum leaves out, relative to the field of a charge at the mean distance; 1e-15..1e-3. Default 1e-11.
    void setTolerance(double tolerance);
    /// Distance [m] up to which pairs are summed one by one. 0, the default, chooses the cheapest for the number of charges
    /// and targets; the result does not depend on it beyond the tolerance.
    void setCutoff(double cutoff);

    /// Field [V/m] and potential [V] at every charge: of all others and of all images, its own images included, without its
    /// own Coulomb term. Throws std::domain_error naming a row that is not inside the box or not finite, or two rows at one
    /// position.
    void compute(const Points& position, const Scalars& charge, Points& field, Scalars& potential) const;

    /// The same at some points only, at a cost of O(charges targets) at most.
    /// @param targets  points inside the box [m]
    /// @param ownRow   row of the charge that sits at the target and whose own Coulomb term is left out, or -1
    void computeAt(const Points& position, const Scalars& charge, const Points& targets,
                   const std::vector<Index>& ownRow, Points& field, Scalars& potential) const;

    /// The cutoff [m] that compute takes for that many charges and targets.
    double chosenCutoff(Index charges, Index targets) const;

    const Box& box() const { return box_; }

private:
    Points fromLowerCorner(const char* what, const Points& position) const;

    Box box_;
    double permittivity_;
    std::array<BoxAxis, 3> axes_;
    double reach_;       ///< alpha times the cutoff, largest wave number over 2 alpha
    double cutoff_ = 0;  ///< [m]; 0: chosen
};

}  // namespace him
