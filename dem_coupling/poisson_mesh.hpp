// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/cell_mesh.hpp"
#include "electrostatics/mesh_arrays.hpp"
#include "electrostatics/types.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace him {

/// A face between two cells that holds charge of its own.
struct ChargedFace {
    std::vector<Vector3> corners;  ///< [m], one after the other around it
    std::int32_t cell;             ///< one of its cells
};

/// What a mesh field method needs of a finite-volume mesh besides its cells.
class PoissonMesh : public CellMesh {
public:
    /// Solves laplacian(V) = -rho/eps with the case's boundary conditions. Collective.
    /// @param cellCharge  charge of each local cell [C]
    /// Stops the run when the solver does not converge.
    virtual void solve(const Scalars& cellCharge) = 0;

    virtual Vector3 electricField(Index cell) const = 0;  ///< -grad V of the cell [V/m] (R30), after solve()
    virtual double potential(Index cell) const = 0;       ///< [V], after any solve

    /// Box around the points of every local cell [m]. Made anew at every call.
    virtual std::vector<Box> cellBoxes() const { throw std::logic_error("this mesh knows no points of its cells"); }

    // --- What p3m needs besides. The mesh part of the potential lives under boundary values of its own.

    /// This rank's cells and faces; valid while the mesh lives and does not move.
    virtual const MeshArrays& arrays() const { throw std::logic_error("this mesh has no arrays"); }

    /// Solves laplacian(V) = -rho/eps with these boundary values, one per face of arrays().boundary: the potential [V] on
    /// conductors, the outward normal gradient [V/m] on insulated faces. Collective; does not update electricField().
    virtual void solve(const Scalars& cellCharge, const Scalars& boundaryValue)
    {
        static_cast<void>(cellCharge);
        static_cast<void>(boundaryValue);
        throw std::logic_error("this mesh solves with the case's boundary conditions only");
    }

    /// Adds to the potential the solution of laplacian(dV) = -residual/(eps volume) with zero boundary values: one deferred
    /// correction. Collective.
    /// @param residual  charge of each local cell [C] that the potential does not account for yet
    virtual void correct(const Scalars& residual)
    {
        static_cast<void>(residual);
        throw std::logic_error("this mesh has no correction");
    }

    /// Faces of insulating walls inside the mesh that this rank counts, and their present charge [C] in the same order. They
    /// are left out of solve(cellCharge, boundaryValue): p3m treats them like particles.
    virtual std::vector<ChargedFace> chargedFaces() const { return {}; }
    virtual void faceCharges(Scalars& charge) const { charge.resize(0); }
    /// Whether the gas's permittivity holds in all cells and no wall carries charge of its own, so that the charges and the
    /// edge of the mesh alone make the field.
    virtual bool chargesAlone() const { return true; }
    /// What of the mesh p3m could not give its due, as a clause for a message: a patch that is neither conductor nor insulated,
    /// cells of another permittivity than the gas. Empty where there is nothing. The same on all ranks; not collective.
    virtual std::string unknownToP3m() const { return {}; }

    /// Asks for the operator of matchedSymbol() (electrostatics/p3m/lattice_operator.hpp) in place of the finite-volume one
    /// in solve(cellCharge, boundaryValue), whose boundary values are all zero from then on. True when the mesh has one: the
    /// direct solve of a uniform grounded box; no deferred correction is needed then. Collective.
    virtual bool useMatchedOperator() { return false; }
    /// Back to the finite-volume operator, when another method has asked for the matched one.
    virtual void useFiniteVolumeOperator() {}

    /// What the next solve starts from. Put back, it makes solves in between leave no trace: a run with probes and references
    /// goes on bit for bit as one without. Null where a mesh has nothing to keep.
    struct Kept {
        virtual ~Kept() = default;
    };
    virtual std::unique_ptr<Kept> keep() const { return nullptr; }
    /// The next solve starts from nothing, so that its result does not depend on the solves before it. No line of the log tells of
    /// solves from now to restore().
    virtual void forgetPotential() {}
    /// Collective.
    virtual void restore(const Kept* kept) { static_cast<void>(kept); }

    /// One line for logs and tables: cells, solver, tolerance.
    virtual std::string description() const { return {}; }
};

}  // namespace him
