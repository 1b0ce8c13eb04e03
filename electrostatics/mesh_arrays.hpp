// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <cstdint>
#include <vector>

namespace him {

/// What the edge of the mesh does to the potential.
enum class FaceCondition : std::uint8_t {
    conductor,  ///< the potential of the face is given
    insulated,  ///< the outward normal gradient is given, zero on zeroGradient and symmetry patches
    other       ///< neither, as on an insulating wall with a conductor behind it: the mesh solves, p3m refuses
};

/// Faces at which the mesh ends, one row each. Faces to another rank or to a periodic copy are not among them.
struct BoundaryFaces {
    Points centre;   ///< [m]
    Points normal;   ///< unit vector out of the mesh
    Scalars area;    ///< [m2]
    Scalars radius;  ///< largest distance from the centre to a point of the face [m]
    Scalars value;   ///< of the case's own condition: voltage [V] on conductors, 0 on insulated faces
    std::vector<std::int32_t> cell;
    std::vector<FaceCondition> condition;

    Index size() const { return static_cast<Index>(cell.size()); }
};

/// Faces between two cells of one rank.
struct InternalFaces {
    Points centre;      ///< [m]
    Points areaVector;  ///< [m2], from owner to neighbour
    std::vector<std::int32_t> owner, neighbour;

    Index size() const { return static_cast<Index>(owner.size()); }
};

/// Faces whose other side is a cell of another rank, or a periodic copy of a cell (of this rank too).
struct CoupledFaces {
    Points centre;      ///< [m], as this rank's cell sees it
    Points areaVector;  ///< [m2], out of this rank's cell
    Points shift;       ///< [m] the copy stands at its own centre + shift; zero where nothing is periodic
    std::vector<std::int32_t> cell;       ///< this side
    std::vector<std::int32_t> otherRank;  ///< where the other side lives
    std::vector<std::int32_t> otherCell;  ///< its number there

    Index size() const { return static_cast<Index>(cell.size()); }
};

/// One rank's finite-volume mesh as plain arrays. SI units.
struct MeshArrays {
    Points centre;   ///< of every cell, centroid [m]
    Scalars volume;  ///< [m3]
    Scalars radius;  ///< largest distance from a cell's centre to its points [m]
    InternalFaces internal;
    BoundaryFaces boundary;
    CoupledFaces coupled;

    Index cells() const { return centre.rows(); }
};

}  // namespace him
