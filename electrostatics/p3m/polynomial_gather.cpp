// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/polynomial_gather.hpp"

#include "electrostatics/p3m/blocks.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Relative places are rounded to this share of the cell size, so that stencils which differ by round-off are the same and
/// the fit does not depend on which came first.
constexpr double rounding = 1e-7;

/// A fit whose gradient at the rim of the cell magnifies errors of the values more than this is refused.
constexpr double mostAmplification = 30;

/// Least number of points for an order: about three per coefficient for cubic, as the layers of a hexahedral mesh give.
int fewestPoints(int order)
{
    return order == 4 ? 100 : 50;
}

double weightOf(double squaredDistance, int order)
{
    return order == 4 ? std::pow(1.0 + squaredDistance, -6) : std::pow(0.3 + squaredDistance, -4);
}

std::uint64_t hashOf(const std::vector<std::int64_t>& key)
{
    std::uint64_t hash = 1469598103934665603ULL;
    for (const std::int64_t value : key) {
        hash = (hash ^ static_cast<std::uint64_t>(value)) * 1099511628211ULL;
        hash ^= hash >> 29;
    }
    return hash;
}

/// sums[k] = sum over points of values[p] matrix[p][k], `blocks` blocks of k. Their number is fixed, so that the sums stay in
/// registers.
template <int blocks>
inline __attribute__((always_inline)) void accumulateBlocks(const double* matrix, const double* values, int points,
                                                            double* sums)
{
    Block total[blocks] = {};
    for (int p = 0; p < points; ++p, matrix += blocks * blockSize) {
#pragma GCC unroll 16
        for (int b = 0; b < blocks; ++b) {
            total[b] += load(matrix + b * blockSize) * values[p];
        }
    }
#pragma GCC unroll 16
    for (int b = 0; b < blocks; ++b) {
        store(sums + b * blockSize, total[b]);
    }
}

constexpr int blocksOf(int order)
{
    return (coefficientsOf(order) + blockSize - 1) / blockSize;
}

HIM_CLONES void accumulate(int order, const double* matrix, const double* values, int points, double* sums)
{
    switch (order) {
    case 4:
        return accumulateBlocks<blocksOf(4)>(matrix, values, points, sums);
    case 3:
        return accumulateBlocks<blocksOf(3)>(matrix, values, points, sums);
    case 2:
        return accumulateBlocks<blocksOf(2)>(matrix, values, points, sums);
    default:
        return accumulateBlocks<blocksOf(1)>(matrix, values, points, sums);
    }
}

}  // namespace

PolynomialGather::PolynomialGather(const LocalMesh& mesh, const SurroundingsTable& walls, int order)
    : mesh_(mesh),
      walls_(walls),
      order_(order),
      stencils_(static_cast<std::size_t>(mesh.ownCells)),
      firstNode_(static_cast<std::size_t>(mesh.cells()), -1)
{
}

bool PolynomialGather::givesValue(std::int32_t face) const
{
    return mesh_.boundary.condition[static_cast<std::size_t>(face)] != FaceCondition::insulated;
}

bool PolynomialGather::mirrors(Index face) const
{
    return walls_.mirrorsExactly(face) && mesh_.boundary.value[face] == 0;
}

const PolynomialGather::Stencil& PolynomialGather::stencilOf(Index cell)
{
    Stencil& stencil = stencils_[static_cast<std::size_t>(cell)];
    if (!stencil.fit) {
        stencil = make(cell);
    }
    return stencil;
}

/// Whole layers of cells until there are enough points, boundary faces included. The cell itself is no point. A layer goes
/// through a face to the cell behind it, or through a mirroring wall to the same cell on the other side.
void PolynomialGather::collect(Index cell, Stencil& stencil)
{
    nodes_.clear();
    nextNode_.clear();
    const auto add = [&](const Node& node) {
        std::int32_t& first = firstNode_[static_cast<std::size_t>(node.cell)];
        for (std::int32_t n = first; n >= 0; n = nextNode_[static_cast<std::size_t>(n)]) {
            if (nodes_[static_cast<std::size_t>(n)].planes == node.planes) {
                return;
            }
        }
        nextNode_.push_back(first);
        first = static_cast<std::int32_t>(nodes_.size());
        nodes_.push_back(node);
    };
    const auto placeOf = [&](std::int32_t other, const std::array<std::int32_t, 3>& planes) {
        Vector3 place = mesh_.centreOf(other);
        for (const std::int32_t plane : planes) {
            if (plane >= 0) {
                place = walls_.planes()[static_cast<std::size_t>(plane)].mirror(place);
            }
        }
        return place;
    };
    constexpr std::array<std::int32_t, 3> unmirrored{-1, -1, -1};
    add({static_cast<std::int32_t>(cell), 1, unmirrored, mesh_.centreOf(cell)});
    std::size_t begin = 0;
    std::size_t faces = 0;
    for (int layer = 1;
         layer <= layers(order_) && nodes_.size() - 1 + faces < static_cast<std::size_t>(fewestPoints(order_));
         ++layer) {
        const std::size_t end = nodes_.size();
        for (; begin < end; ++begin) {
            const Node here = nodes_[begin];
            for (const std::int32_t neighbour : mesh_.neighbours[here.cell]) {
                add({neighbour, here.sign, here.planes, placeOf(neighbour, here.planes)});
            }
            for (const std::int32_t face : mesh_.facesOfCell[here.cell]) {
                if (!mirrors(face)) {
                    faces += here.planes == unmirrored;
                    continue;
                }
                // Through a plane and back again is no mirroring at all.
                const auto plane = static_cast<std::int32_t>(walls_.planeOf(face));
                std::array<std::int32_t, 3> planes = here.planes;
                auto at = std::find(planes.begin(), planes.end(), plane);
                if (at != planes.end()) {
                    *at = -1;
                } else if (planes[0] < 0) {
                    planes[0] = plane;
                } else {
                    continue;  // three planes already, or the far wall of a channel narrower than the stencil
                }
                std::sort(planes.begin(), planes.end());
                const bool conductor = walls_.planes()[static_cast<std::size_t>(plane)].sign < 0;
                add({here.cell, conductor ? -here.sign : here.sign, planes, placeOf(here.cell, planes)});
            }
        }
    }
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const Node& node = nodes_[n];
        firstNode_[static_cast<std::size_t>(node.cell)] = -1;
        if (n > 0) {
            stencil.cells.push_back({node.cell, node.sign});
        }
        if (node.planes == unmirrored) {
            for (const std::int32_t face : mesh_.facesOfCell[node.cell]) {
                if (!mirrors(face)) {
                    stencil.faces.push_back(face);
                }
            }
        }
    }
}

/// Inverse root of the mean second moment of the steps to the neighbours (doubled steps to boundary faces): 1/h on cubes,
/// and coordinates in which a stretched cell becomes one.
Eigen::Matrix3d PolynomialGather::scaleOf(Index cell) const
{
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    const Vector3 centre = mesh_.centreOf(cell);
    int steps = 0;
    for (const std::int32_t neighbour : mesh_.neighbours[cell]) {
        const Vector3 step = mesh_.centreOf(neighbour) - centre;
        moment += step * step.transpose();
        ++steps;
    }
    for (const std::int32_t face : mesh_.facesOfCell[cell]) {
        const Vector3 step = 2 * (mesh_.boundary.centre.row(face).matrix().transpose() - centre);
        moment += step * step.transpose();
        ++steps;
    }
    moment *= 3.0 / steps;
    const double h = cellSize(mesh_, cell);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moment);
    // Round-off must not tell equal cells apart: the scale is rounded like the places.
    Eigen::Matrix3d scale = eigen.eigenvectors()
                            * eigen.eigenvalues().cwiseMax(1e-12 * h * h).cwiseSqrt().cwiseInverse().asDiagonal()
                            * eigen.eigenvectors().transpose();
    scale = ((scale * h / rounding).array().round() * (rounding / h)).matrix();
    return scale;
}

const PolynomialGather::Fit* PolynomialGather::fitOf(Index cell, Stencil& stencil)
{
    const Vector3 centre = mesh_.centreOf(cell);
    const Eigen::Matrix3d scale = scaleOf(cell);
    const double h = cellSize(mesh_, cell);
    const double hRounded = std::exp(std::round(std::log(h) / rounding) * rounding);

    struct FitPoint {
        std::array<std::int64_t, 4> key;  // kind, rounded place
        std::int32_t index;
        std::int32_t sign;
    };
    std::vector<FitPoint> points;
    const auto rounded = [&](const Vector3& x, int axis) {
        return std::llround((x[axis] - centre[axis]) / (h * rounding));
    };
    for (std::size_t n = 0; n < stencil.cells.size(); ++n) {
        const Vector3& x = nodes_[n + 1].place;
        points.push_back(
            {{0, rounded(x, 0), rounded(x, 1), rounded(x, 2)}, stencil.cells[n].cell, stencil.cells[n].sign});
    }
    for (const std::int32_t face : stencil.faces) {
        const Vector3 x = mesh_.boundary.centre.row(face).matrix().transpose();
        points.push_back({{givesValue(face) ? 1 : 2, rounded(x, 0), rounded(x, 1), rounded(x, 2)}, face, 1});
    }
    std::sort(points.begin(), points.end(), [](const FitPoint& a, const FitPoint& b) { return a.key < b.key; });
    stencil.cells.clear();
    stencil.faces.clear();
    std::vector<std::int64_t> key{std::llround(std::log(h) / rounding)};
    for (int i = 0; i < 9; ++i) {
        key.push_back(std::llround(scale(i) * h / rounding));
    }
    for (const FitPoint& point : points) {
        key.insert(key.end(), point.key.begin(), point.key.end());
        if (point.key[0] == 0) {
            stencil.cells.push_back({point.index, point.sign});
        } else {
            stencil.faces.push_back(point.index);
        }
        if (point.key[0] == 2) {
            for (int axis = 0; axis < 3; ++axis) {
                key.push_back(std::llround(mesh_.boundary.normal(point.index, axis) / rounding));
            }
        }
    }
    auto& known = fits_[hashOf(key)];
    for (const auto& fit : known) {
        if (fit->key == key) {
            return fit.get();
        }
    }

    auto fit = std::make_unique<Fit>();
    fit->scale = scale;
    const auto rows = static_cast<Index>(points.size());
    for (int order = order_; order >= 1; --order) {
        const int columns = coefficientsOf(order);
        if (rows < columns) {
            continue;
        }
        Eigen::MatrixXd weighted(rows, columns);
        Eigen::VectorXd weights(rows);
        std::array<double, LocalPolynomial::mostCoefficients> row{};
        for (Index n = 0; n < rows; ++n) {
            const FitPoint& point = points[static_cast<std::size_t>(n)];
            const Vector3 step = Vector3(static_cast<double>(point.key[1]), static_cast<double>(point.key[2]),
                                         static_cast<double>(point.key[3]))
                                 * (h * rounding);
            const Vector3 xi = scale * step;
            weights[n] = std::sqrt(weightOf(xi.squaredNorm(), order));
            if (point.key[0] == 2) {
                const Vector3 normal = mesh_.boundary.normal.row(point.index).matrix().transpose();
                derivatives(xi, hRounded * (scale * normal), order, row.data());  // the value is h times the gradient
            } else {
                monomials(xi, order, row.data());
            }
            weighted.row(n) = weights[n] * Eigen::Map<Eigen::RowVectorXd>(row.data(), columns);
        }
        const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weighted);
        if (qr.rank() < columns) {
            continue;
        }
        const Eigen::MatrixXd inverse = qr.solve(Eigen::MatrixXd(weights.asDiagonal()));

        // How much the gradient at the rim of the cell magnifies errors of the values.
        double amplification = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const Vector3 xi(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            for (int axis = 0; axis < 3; ++axis) {
                derivatives(xi, Vector3::Unit(axis), order, row.data());
                const Eigen::RowVectorXd gradient = Eigen::Map<Eigen::RowVectorXd>(row.data(), columns) * inverse;
                amplification = std::max(amplification, gradient.cwiseAbs().sum());
            }
        }
        if (amplification > mostAmplification && order > 1) {
            continue;
        }
        fit->order = order;
        const int padded = blocksOf(order) * blockSize;
        fit->matrix.assign(static_cast<std::size_t>(rows * padded), 0.0);
        fit->laplacian.assign(static_cast<std::size_t>(rows), 0.0);
        // Second derivatives of the monomials of degree 2 at xi = 0, through the scale.
        const Eigen::Matrix3d metric = scale * scale.transpose();
        const std::array<double, 6> second{2 * metric(0, 0), 2 * metric(0, 1), 2 * metric(0, 2),
                                           2 * metric(1, 1), 2 * metric(1, 2), 2 * metric(2, 2)};
        for (Index n = 0; n < rows; ++n) {
            for (int k = 0; k < columns; ++k) {
                fit->matrix[static_cast<std::size_t>(n * padded + k)] = inverse(k, n);
            }
            for (int k = 0; order >= 2 && k < 6; ++k) {
                fit->laplacian[static_cast<std::size_t>(n)] += second[static_cast<std::size_t>(k)] * inverse(3 + k, n);
            }
        }
        break;
    }
    fit->key = std::move(key);
    known.push_back(std::move(fit));
    return known.back().get();
}

PolynomialGather::Stencil PolynomialGather::make(Index cell)
{
    Stencil stencil;
    collect(cell, stencil);
    stencil.fit = fitOf(cell, stencil);
    fallbacks_ += stencil.fit->order < order_;
    return stencil;
}

void PolynomialGather::fit(Index cell, const Scalars& cellValues, const Scalars& faceValues,
                           LocalPolynomial& polynomial)
{
    const Stencil& stencil = stencilOf(cell);
    const Fit& fit = *stencil.fit;
    polynomial.centre = mesh_.centreOf(cell);
    polynomial.scale = fit.scale;
    polynomial.value = cellValues[cell];
    polynomial.order = fit.order;
    polynomial.coefficients.fill(0.0);
    const auto points = static_cast<Index>(stencil.cells.size() + stencil.faces.size());
    if (values_.size() < points) {
        values_.resize(2 * points);
    }
    double* value = values_.data();
    for (const Point& point : stencil.cells) {
        *value++ = point.sign * cellValues[point.cell] - polynomial.value;
    }
    const double h = stencil.faces.empty() ? 0 : cellSize(mesh_, cell);
    for (const std::int32_t face : stencil.faces) {
        *value++ = givesValue(face) ? faceValues[face] - polynomial.value : h * faceValues[face];
    }
    accumulate(fit.order, fit.matrix.data(), values_.data(), static_cast<int>(points), polynomial.coefficients.data());
}

double PolynomialGather::laplacian(Index cell, const Scalars& cellValues, const Scalars& faceValues)
{
    const Stencil& stencil = stencilOf(cell);
    const double value = cellValues[cell];
    const double* weight = stencil.fit->laplacian.data();
    double sum = 0;
    for (const Point& point : stencil.cells) {
        sum += *weight++ * (point.sign * cellValues[point.cell] - value);
    }
    const double h = stencil.faces.empty() ? 0 : cellSize(mesh_, cell);
    for (const std::int32_t face : stencil.faces) {
        sum += *weight++ * (givesValue(face) ? faceValues[face] - value : h * faceValues[face]);
    }
    return sum;
}

}  // namespace him
