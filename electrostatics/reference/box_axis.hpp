// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <vector>

namespace him {

/// What bounds a box on one side.
enum class BoxSide {
    grounded,   ///< conductor at 0 V: images of opposite sign
    insulated,  ///< no normal field: images of like sign
    periodic    ///< both sides of the direction or none
};

/// One direction of a box: its images and its orthonormal modes, the eigenfunctions of -d2/dx2 under the conditions at both
/// ends. Coordinates start at the lower side.
class BoxAxis {
public:
    BoxAxis(double length, BoxSide lower, BoxSide upper);

    double length() const { return length_; }
    bool grounded() const { return lower_ == BoxSide::grounded || upper_ == BoxSide::grounded; }

    struct Image {
        double position;   ///< [m]
        double direction;  ///< -1 when mirrored
        double sign;       ///< of the charge
    };
    /// Images of a point, the point itself first, that are no farther than `margin` [m] from the box.
    void images(double position, double margin, std::vector<Image>& list) const;

    /// Wave number [1/m] of a mode; modes are in rising order from 0.
    double waveNumber(Index mode) const;
    /// Number of modes with a wave number of at most `largest` [1/m].
    Index modesUpTo(double largest) const;
    /// Values and derivatives of the first `modes` modes at the points: one row per mode, one column per point.
    void evaluate(const Eigen::Ref<const Scalars>& position, Index modes, Eigen::MatrixXd& value,
                  Eigen::MatrixXd& derivative) const;

private:
    double length_;
    BoxSide lower_, upper_;
};

}  // namespace him
