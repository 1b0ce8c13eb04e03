// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/reference/box_axis.hpp"
#include "electrostatics/reference/ewald_kernel.hpp"

#include <array>
#include <vector>

namespace him {

/// What the two halves of Ewald's sum in a box work on; positions from the lower corner of the box [m]. The field and the
/// potential lack the factor 1/(4 pi eps).
struct BoxSum {
    const std::array<BoxAxis, 3>& axes;
    const Points& position;
    const Scalars& charge;
    const Points& targets;
    const std::vector<Index>& ownRow;
};

/// Rectangle of modes along x and y that go with one mode along z.
struct ModeLayer {
    Index x, y;
};

/// The modes with a wave number of at most `largest` [1/m], and some beyond it: for each mode along z a rectangle.
std::vector<ModeLayer> modeLayers(const std::array<BoxAxis, 3>& axes, double largest);

/// Adds the pairs within `cutoff` [m] of each other under the screened kernel, all images included.
void addScreenedPairs(const BoxSum& sum, const EwaldKernel& kernel, double cutoff, Points& field, Scalars& potential);

/// Adds the field of the Gaussian clouds of all charges, a target's own cloud included.
void addModes(const BoxSum& sum, double alpha, double largestWaveNumber, Points& field, Scalars& potential);

}  // namespace him
