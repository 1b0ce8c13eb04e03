// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/near_field.hpp"

namespace him {

/// R29 within a cutoff and, if wanted, less R31, by the double loop. `scale` is the sum of the absolute contributions, the
/// measure of round-off.
struct BruteForce {
    Points field;
    Scalars potential;
    Scalars fieldScale;
    Scalars potentialScale;
    std::int64_t pairs = 0;
};

BruteForce bruteForce(const ChargedPoints& points, double cutoff, double permittivity, bool withoutDoubleCount);

/// The short-range part of charge clouds by the double loop.
BruteForce bruteForceScreened(const ChargedPoints& points, const ChargeCloud& cloud, double permittivity);

/// Points of unit scale in a box of the given edges, charges of both signs, every point a target, mesh cells of 0.1.
ChargedPoints randomPoints(Index count, double edgeX, double edgeY, double edgeZ, unsigned seed);

/// Three tight clusters and a thin cloud.
ChargedPoints clusteredPoints(Index count, unsigned seed);

void setCells(ChargedPoints& points, double cellEdge);

}  // namespace him
