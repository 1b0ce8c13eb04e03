// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/local_mesh.hpp"

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace him {

/// Weighted least-squares polynomials through the own value of a cell, over a few layers of cells around it and the
/// boundary faces among them: values on conductors, normal gradients on insulated faces. Cells whose stencils look alike
/// share one fit, so a uniform mesh needs a handful of them.
class PolynomialGather {
public:
    static constexpr int mostCoefficients = 34;

    /// @param order  3 or 4; where a stencil cannot carry it, the highest order that it can is taken and counted
    PolynomialGather(const LocalMesh& mesh, int order);

    /// The polynomial of one cell: values at the scaled place xi = scale (x - centre).
    struct Polynomial {
        Vector3 centre;
        Eigen::Matrix3d scale;                              ///< [1/m]
        double value = 0;                                   ///< at the centre
        std::array<double, mostCoefficients + 6> coefficients{};  ///< of the monomials of degree 1 to 4, padded
        int order = 0;

        double at(const Vector3& x) const;
        Vector3 gradient(const Vector3& x) const;  ///< per metre
    };

    /// Fits the values of cells and boundary faces around an own cell.
    void fit(Index cell, const Scalars& cellValues, const Scalars& faceValues, Polynomial& polynomial);

    /// Laplacian [1/m2] of the polynomial at the centre of an own cell.
    double laplacian(Index cell, const Scalars& cellValues, const Scalars& faceValues);

    /// Points of the stencil of an own cell: cells, then boundary faces.
    const std::vector<std::int32_t>& stencilCells(Index cell) { return stencilOf(cell).cells; }
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
        int padded = 0;              ///< coefficients per point, with padding
        std::vector<double> matrix;  ///< `padded` numbers per point
        std::vector<double> laplacian;  ///< one number per point [1/m2]
        Eigen::Matrix3d scale;
    };
    struct Stencil {
        std::vector<std::int32_t> cells, faces;
        const Fit* fit = nullptr;
    };
    const Stencil& stencilOf(Index cell);
    Stencil make(Index cell);
    void collect(Index cell, Stencil& stencil);
    Eigen::Matrix3d scaleOf(Index cell) const;
    const Fit* fitOf(Index cell, Stencil& stencil);

    const LocalMesh& mesh_;
    int order_;
    Index fallbacks_ = 0;
    std::vector<Stencil> stencils_;
    std::unordered_map<std::uint64_t, std::vector<std::unique_ptr<Fit>>> fits_;
    std::vector<std::int32_t> mark_;
    std::int32_t stamp_ = 0;
};

}  // namespace him
