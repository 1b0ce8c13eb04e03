// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/local_polynomial.hpp"
#include "electrostatics/p3m/surroundings.hpp"

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace him {

/// Weighted least-squares polynomials through the own value of a cell, over a few layers of cells around it. Where charges
/// are mirrored exactly in a wall without voltage, the layers go on behind it with the mirrored cells and their values,
/// negative at a conductor; elsewhere boundary faces are points of their own: values on conductors, normal gradients on
/// insulated faces. Cells whose stencils look alike share one fit, so a
/// uniform mesh needs a handful of them.
class PolynomialGather {
public:
    /// @param mesh, walls  outlive this
    /// @param order        3 or 4; where a stencil cannot carry it, the highest order that it can is taken and counted
    PolynomialGather(const LocalMesh& mesh, const SurroundingsTable& walls, int order);

    /// Fits the values of cells and boundary faces around an own cell.
    void fit(Index cell, const Scalars& cellValues, const Scalars& faceValues, LocalPolynomial& polynomial);

    /// Laplacian [1/m2] of the polynomial at the centre of an own cell.
    double laplacian(Index cell, const Scalars& cellValues, const Scalars& faceValues);

    /// A cell of a stencil, or its mirror image behind walls.
    struct Point {
        std::int32_t cell;
        std::int32_t sign;  ///< of the value: -1 behind an odd number of conductors
    };
    /// Points of the stencil of an own cell: cells, and boundary faces.
    const std::vector<Point>& stencilCells(Index cell) { return stencilOf(cell).cells; }
    const std::vector<std::int32_t>& stencilFaces(Index cell) { return stencilOf(cell).faces; }

    /// Own cells, among those asked for, whose stencil did not carry the asked order.
    Index fallbacks() const { return fallbacks_; }
    /// Layers of cells that stencils may need around the own ones.
    static int layers(int order) { return order == 4 ? 5 : 4; }

private:
    /// Everything that does not depend on where the stencil stands.
    struct Fit {
        std::vector<std::int64_t> key;
        int order = 0;
        std::vector<double> matrix;     ///< coefficients per point, padded to whole blocks
        std::vector<double> laplacian;  ///< one number per point [1/m2]
        Eigen::Matrix3d scale;
    };
    struct Stencil {
        std::vector<Point> cells;
        std::vector<std::int32_t> faces;
        const Fit* fit = nullptr;
    };
    const Stencil& stencilOf(Index cell);
    Stencil make(Index cell);
    void collect(Index cell, Stencil& stencil);
    /// Whether a boundary face is a point with a value; else it gives the normal gradient.
    bool givesValue(std::int32_t face) const;
    /// Whether the layers of a stencil go on behind this boundary face.
    bool mirrors(Index face) const;
    Eigen::Matrix3d scaleOf(Index cell) const;
    const Fit* fitOf(Index cell, Stencil& stencil);

    const LocalMesh& mesh_;
    const SurroundingsTable& walls_;
    int order_;
    Index fallbacks_ = 0;
    std::vector<Stencil> stencils_;
    std::unordered_map<std::uint64_t, std::vector<std::unique_ptr<Fit>>> fits_;
    /// Scratch of collect(): a cell as it stands behind some walls, in the order found.
    struct Node {
        std::int32_t cell;
        std::int32_t sign;
        std::array<std::int32_t, 3> planes;  ///< that it is mirrored in, ascending, -1 for none
        Vector3 place;                       ///< [m]
    };
    std::vector<Node> nodes_;
    std::vector<std::int32_t> firstNode_, nextNode_;  ///< nodes of each cell, chained
    Scalars values_;
};

}  // namespace him
