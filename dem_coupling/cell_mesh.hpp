// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

namespace him {

/// Cells of a mesh that particles are sought in. SI units. Cell indices are local to the rank.
class CellMesh {
public:
    virtual ~CellMesh() = default;

    virtual Box localBounds() const = 0;             ///< bounds of this rank's cells [m]; empty when it has none
    virtual Index cellCount() const = 0;             ///< cells of this rank
    virtual double largestCellDiagonal() const = 0;  ///< over all ranks [m]; not collective
    /// Local cell that holds the point, or -1. Not collective.
    virtual Index findCell(const Vector3& point) const = 0;
    /// Whether a quick look shows that findCell() would name this cell; false says nothing. Not collective.
    virtual bool surelyHolds(Index /*cell*/, const Vector3& /*point*/) const { return false; }
    virtual Vector3 cellCentre(Index cell) const = 0;  ///< [m]
};

}  // namespace him
