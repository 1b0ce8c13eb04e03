// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <string>
#include <vector>

namespace him {

/// What a mesh field method needs of a finite-volume mesh. SI units. Cell indices are local to the rank.
class PoissonMesh {
public:
    virtual ~PoissonMesh() = default;

    virtual Box localBounds() const = 0;             ///< bounds of this rank's cells [m]; empty when it has none
    virtual Index cellCount() const = 0;             ///< cells of this rank
    virtual double largestCellDiagonal() const = 0;  ///< over all ranks [m]; not collective
    /// Local cell that holds the point, or -1. Not collective.
    virtual Index findCell(const Vector3& point) const = 0;
    virtual Vector3 cellCentre(Index cell) const = 0;  ///< [m]

    /// Solves laplacian(V) = -rho/eps with the case's boundary conditions. Collective.
    /// @param cellCharge  charge of each local cell [C]
    /// Stops the run when the solver does not converge.
    virtual void solve(const Scalars& cellCharge) = 0;

    virtual Vector3 electricField(Index cell) const = 0;  ///< -grad V of the cell [V/m] (R30), after solve()
    virtual double potential(Index cell) const = 0;       ///< [V], after solve()
};

}  // namespace him
