// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/mesh_halo.hpp"
#include "dem_coupling/poisson_mesh.hpp"
#include "electrostatics/p3m/cloud_deposit.hpp"
#include "electrostatics/p3m/polynomial_gather.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <mpi.h>
#include <vector>

namespace him {

/// What the mesh of p3m gives back to a charge of its own cloud: everything between deposit and gather is linear, so the answer to
/// each cell's charge and to each wall face's value, gathered in every cell that it matters to, adds up to that to any charge
/// wherever it stands in its cell. One solve for each cell and wall face, made when a cloud first reaches it.
class OwnResponseTable {
public:
    /// Potential [V] of all cells of the local mesh for charges [C] of the own cells and values of the own boundary faces; brings
    /// the values of the other faces. Collective.
    using Solve = std::function<void(const Scalars& cellCharge, Scalars& faceValue, Scalars& cellPotential)>;

    /// Collective. All but `communicator` outlive this.
    /// @param order  of the gather
    OwnResponseTable(PoissonMesh& mesh, MeshHalo& halo, SurroundingsTable& table, PolynomialGather& gather, int order,
                     MPI_Comm communicator);

    /// Whether the mesh is small enough: one solve for each cell, and coefficients for all cells around each cell. Collective.
    static bool fits(const LocalMesh& mesh, SurroundingsTable& table, int order, MPI_Comm communicator);

    /// Makes what the targets' cells need and is not there yet. Leaves the mesh as it was. Collective.
    void extend(const CloudSources& sources, const Solve& solve);

    /// Gradient [V/m], at a target, of the potential that the mesh makes of the target's own charge and images.
    /// @param charge     of the cells around, from CloudDeposit::depositOne()
    /// @param permittivity  eps [F/m]
    Vector3 gradient(const CloudSources& sources, Index target, const Scalars& charge, const ChargeCloud& cloud,
                     double permittivity);

private:
    /// Answers gathered in one own cell.
    struct Host {
        std::vector<float> ofCells;       ///< coefficients for 1 C in each cell around it
        std::vector<std::int32_t> faces;  ///< wall faces around it whose value its charges change
        std::vector<float> ofFaces;       ///< coefficients for a value of 1 at each of them
        LocalPolynomial frame;            ///< of the polynomial
        bool known = false;
    };
    struct Place {
        std::int32_t host;
        std::int32_t column;
    };
    static int width(int order) { return coefficientsOf(order); }
    void prepareHosts();
    void solveFor(std::int64_t source, bool isFace, const Solve& solve);

    PoissonMesh& mesh_;
    MeshHalo& halo_;
    SurroundingsTable& table_;
    PolynomialGather& gather_;
    int width_;
    MPI_Comm communicator_;
    std::int64_t firstCell_ = 0, firstFace_ = 0;         ///< numbers over all ranks of this rank's first ones
    std::vector<std::int64_t> cellNumber_, faceNumber_;  ///< over all ranks, of the cells and faces of the local mesh
    std::vector<Host> hosts_;
    /// Where the answers to a cell or face go, sorted by its number over all ranks.
    struct Use {
        std::int64_t source;
        Place place;
    };
    std::vector<Use> cellUses_, faceUses_;
    std::vector<bool> cellSolved_, faceSolved_;  ///< by the number over all ranks
    Scalars charge_, faceValue_, potential_;
    LocalPolynomial fitted_;
};

}  // namespace him
