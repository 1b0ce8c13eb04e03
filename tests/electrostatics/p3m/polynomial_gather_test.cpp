// SPDX-License-Identifier: GPL-3.0-or-later
// What the least-squares polynomials reproduce, on stencils that carry the asked order and on those that cannot.
#include "electrostatics/p3m/polynomial_gather.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace him {
namespace {

/// A box of equal cells from the origin whose sides end in conductors at a voltage: walls that hold a voltage are points of
/// their own and never mirrors, so that any potential can stand in their values.
class Block {
public:
    Block(const std::array<Index, 3>& cells, const Vector3& size)
        : cloudRadius(2 * size.maxCoeff()), cells_(cells), size_(size)
    {
        const Index count = cells[0] * cells[1] * cells[2];
        mesh.ownCells = count;
        mesh.centre.resize(count, 3);
        mesh.volume.setConstant(count, size.prod());
        mesh.radius.setConstant(count, 0.5 * size.norm());
        std::vector<Vector3> centre, normal;
        for (Index cell = 0; cell < count; ++cell) {
            const std::array<Index, 3> at{cell % cells[0], cell / cells[0] % cells[1], cell / cells[0] / cells[1]};
            mesh.centre.row(cell) = centreAt(at).transpose().array();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const int side : {-1, 1}) {
                    std::array<Index, 3> other = at;
                    other[axis] += side;
                    if (other[axis] >= 0 && other[axis] < cells[axis]) {
                        mesh.neighbours.entries.push_back(
                            static_cast<std::int32_t>(other[0] + cells[0] * (other[1] + cells[1] * other[2])));
                        continue;
                    }
                    const Vector3 outward = side * Vector3::Unit(static_cast<Index>(axis));
                    mesh.facesOfCell.entries.push_back(static_cast<std::int32_t>(centre.size()));
                    centre.push_back(centreAt(at) + 0.5 * outward.cwiseProduct(size));
                    normal.push_back(outward);
                    mesh.boundary.cell.push_back(static_cast<std::int32_t>(cell));
                }
            }
            mesh.neighbours.closeRow();
            mesh.facesOfCell.closeRow();
        }
        const auto faces = static_cast<Index>(centre.size());
        mesh.ownFaces = faces;
        mesh.boundary.centre.resize(faces, 3);
        mesh.boundary.normal.resize(faces, 3);
        mesh.boundary.area.setConstant(faces, std::pow(size.prod(), 2. / 3));
        mesh.boundary.radius.setConstant(faces, 0.5 * size.norm());
        mesh.boundary.value.setConstant(faces, 1);
        mesh.boundary.condition.assign(centre.size(), FaceCondition::conductor);
        for (Index face = 0; face < faces; ++face) {
            mesh.boundary.centre.row(face) = centre[static_cast<std::size_t>(face)].transpose().array();
            mesh.boundary.normal.row(face) = normal[static_cast<std::size_t>(face)].transpose().array();
        }
    }

    std::vector<Index> allCells() const
    {
        std::vector<Index> cells(static_cast<std::size_t>(mesh.ownCells));
        std::iota(cells.begin(), cells.end(), Index{0});
        return cells;
    }
    Index middle() const { return cells_[0] / 2 + cells_[0] * (cells_[1] / 2 + cells_[1] * (cells_[2] / 2)); }
    const Vector3& cellSizes() const { return size_; }

    LocalMesh mesh;
    double cloudRadius;  ///< [m] two cells

private:
    Vector3 centreAt(const std::array<Index, 3>& at) const
    {
        return Vector3(static_cast<double>(at[0]) + 0.5, static_cast<double>(at[1]) + 0.5,
                       static_cast<double>(at[2]) + 0.5)
            .cwiseProduct(size_);
    }

    std::array<Index, 3> cells_;
    Vector3 size_;
};

/// A potential [V] and its gradient [V/m].
struct Potential {
    std::function<double(const Vector3&)> value;
    std::function<Vector3(const Vector3&)> gradient;
};

/// Every monomial of degree 1 to `order` with a coefficient of its own, about a point in units of `length`.
Potential polynomialOfDegree(int order, const Vector3& about, double length)
{
    std::array<double, LocalPolynomial::mostCoefficients> factor{};
    for (int k = 0; k < coefficientsOf(order); ++k) {
        factor[static_cast<std::size_t>(k)] = 1 + 0.37 * k * (k % 2 == 0 ? 1 : -1);
    }
    return {[=](const Vector3& x) {
                std::array<double, LocalPolynomial::mostCoefficients> terms{};
                monomials((x - about) / length, order, terms.data());
                double sum = 3;
                for (int k = 0; k < coefficientsOf(order); ++k) {
                    sum += factor[static_cast<std::size_t>(k)] * terms[static_cast<std::size_t>(k)];
                }
                return sum;
            },
            [=](const Vector3& x) {
                Vector3 sum = Vector3::Zero();
                for (int axis = 0; axis < 3; ++axis) {
                    std::array<double, LocalPolynomial::mostCoefficients> terms{};
                    derivatives((x - about) / length, Vector3::Unit(axis), order, terms.data());
                    for (int k = 0; k < coefficientsOf(order); ++k) {
                        sum[axis] += factor[static_cast<std::size_t>(k)] * terms[static_cast<std::size_t>(k)] / length;
                    }
                }
                return sum;
            }};
}

/// Fits to a potential that is given exactly at cell centres and boundary faces.
struct Fitted {
    Index fallbacks = 0;
    int lowestOrder = 4, highestOrder = 0;
    double value = 0;      ///< largest error at the corners of the cells, over the largest value there
    double gradient = 0;   ///< likewise
    double laplacian = 0;  ///< at the centres, over the largest gradient by the cell size
};

Fitted fitted(const Block& block, int order, const Potential& potential, const std::vector<Index>& cells)
{
    const LocalMesh& mesh = block.mesh;
    SurroundingsTable walls(mesh, block.cloudRadius);
    PolynomialGather gather(mesh, walls, order);
    Scalars cellValues(mesh.cells());
    Scalars faceValues(mesh.boundary.size());
    for (Index cell = 0; cell < mesh.cells(); ++cell) {
        cellValues[cell] = potential.value(mesh.centreOf(cell));
    }
    for (Index face = 0; face < mesh.boundary.size(); ++face) {
        const Vector3 centre = mesh.boundary.centre.row(face).matrix().transpose();
        const Vector3 normal = mesh.boundary.normal.row(face).matrix().transpose();
        const bool insulated = mesh.boundary.condition[static_cast<std::size_t>(face)] == FaceCondition::insulated;
        faceValues[face] = insulated ? potential.gradient(centre).dot(normal) : potential.value(centre);
    }
    Fitted result;
    double largestValue = 0;
    double largestGradient = 0;
    for (const Index cell : cells) {
        LocalPolynomial polynomial;
        gather.fit(cell, cellValues, faceValues, polynomial);
        result.lowestOrder = std::min(result.lowestOrder, polynomial.order);
        result.highestOrder = std::max(result.highestOrder, polynomial.order);
        for (int corner = 0; corner < 8; ++corner) {
            const Vector3 offset(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            const Vector3 place = mesh.centreOf(cell) + offset.cwiseProduct(block.cellSizes());
            double value = 0;
            Vector3 gradient;
            polynomial.evaluate(place, value, gradient);
            largestValue = std::max(largestValue, std::abs(potential.value(place)));
            largestGradient = std::max(largestGradient, potential.gradient(place).norm());
            result.value = std::max(result.value, std::abs(value - potential.value(place)));
            result.gradient = std::max(result.gradient, (gradient - potential.gradient(place)).norm());
        }
        // Central differences of the gradient of a quartic leave step^2 of its fourth derivatives.
        const double step = 1e-4 * block.cellSizes().minCoeff();
        double laplacian = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Vector3 along = step * Vector3::Unit(axis);
            const Vector3 centre = mesh.centreOf(cell);
            laplacian += (potential.gradient(centre + along) - potential.gradient(centre - along))[axis] / (2 * step);
        }
        result.laplacian =
            std::max(result.laplacian, std::abs(gather.laplacian(cell, cellValues, faceValues) - laplacian));
    }
    result.value /= largestValue;
    result.gradient /= largestGradient;
    result.laplacian /= largestGradient / block.cellSizes().maxCoeff();
    result.fallbacks = gather.fallbacks();
    return result;
}

void expectExact(const Fitted& fit, double tolerance)
{
    EXPECT_LT(fit.value, tolerance);
    EXPECT_LT(fit.gradient, tolerance);
    EXPECT_LT(fit.laplacian, std::max(tolerance, 1e-7));  // of the differences it is compared with
}

TEST(PolynomialGather, reproducesEveryPolynomialOfItsOrderOnAFullStencil)
{
    for (const Vector3& size : {Vector3(1e-3, 1e-3, 1e-3), Vector3(1e-3, 2.5e-3, 0.4e-3)}) {
        const Block block({11, 11, 11}, size);
        const std::vector<Index> middle{block.middle()};
        const Vector3 about = block.mesh.centreOf(block.middle()) + 0.3 * size;
        for (const int order : {3, 4}) {
            for (int degree = 1; degree <= order; ++degree) {
                const Fitted fit = fitted(block, order, polynomialOfDegree(degree, about, 1e-3), middle);
                expectExact(fit, 1e-12);
                EXPECT_EQ(fit.lowestOrder, order);
                EXPECT_EQ(fit.fallbacks, 0);
            }
        }
        EXPECT_GT(fitted(block, 3, polynomialOfDegree(4, about, 1e-3), middle).gradient, 1e-3);
    }
}

/// A mesh whose stencils carry only a lower order than asked.
struct Narrow {
    const char* name;
    std::array<Index, 3> cells;
    int asked, carried;
};

void PrintTo(const Narrow& narrow, std::ostream* out)
{
    *out << narrow.name;
}

class PolynomialGatherInNarrowMeshes : public testing::TestWithParam<Narrow> {};
INSTANTIATE_TEST_SUITE_P(OfFewCells, PolynomialGatherInNarrowMeshes,
                         testing::Values(Narrow{"oneCell", {1, 1, 1}, 4, 1}, Narrow{"threeInARow", {3, 1, 1}, 3, 1},
                                         Narrow{"squareChannelOneCellWide", {9, 1, 1}, 4, 1},
                                         Narrow{"fourInAPlane", {2, 2, 1}, 3, 2},
                                         Narrow{"flatChannelOneCellWideCubic", {9, 9, 1}, 3, 2},
                                         Narrow{"flatChannelOneCellWideQuartic", {9, 9, 1}, 4, 2},
                                         Narrow{"eightCells", {2, 2, 2}, 4, 3},
                                         Narrow{"flatChannelTwoCellsWide", {6, 6, 2}, 4, 3}),
                         [](const auto& narrow) { return std::string(narrow.param.name); });

TEST_P(PolynomialGatherInNarrowMeshes, fallBackToTheOrderThatTheStencilCarriesAndCountIt)
{
    const Narrow& narrow = GetParam();
    for (const FaceCondition condition : {FaceCondition::conductor, FaceCondition::insulated}) {
        Block block(narrow.cells, Vector3(1e-3, 1e-3, 1e-3));
        block.mesh.boundary.condition.assign(block.mesh.boundary.condition.size(), condition);
        // Normal gradients enter in units of a cell size that the fit rounds by 1e-7, so that equal cells share one fit.
        const double tolerance = condition == FaceCondition::conductor ? 1e-12 : 1e-7;
        const Vector3 about = block.mesh.centreOf(block.middle()) + Vector3(1e-4, 2e-4, -1e-4);
        for (int degree = 1; degree <= narrow.carried; ++degree) {
            const Fitted fit = fitted(block, narrow.asked, polynomialOfDegree(degree, about, 1e-3), block.allCells());
            expectExact(fit, tolerance);
            EXPECT_EQ(fit.lowestOrder, narrow.carried);
            EXPECT_EQ(fit.highestOrder, narrow.carried);
            EXPECT_EQ(fit.fallbacks, block.mesh.ownCells);
        }
        const Potential beyond = polynomialOfDegree(narrow.carried + 1, about, 1e-3);
        EXPECT_GT(fitted(block, narrow.asked, beyond, block.allCells()).gradient, 1e-3);
    }
}

TEST(PolynomialGather, fallsBackFromQuarticInTheCornersOfConductorsAtAVoltage)
{
    // A corner has points enough and full rank, but the gradient at its rim would magnify errors of the values too much.
    const Block block({7, 6, 5}, Vector3(1e-3, 1e-3, 1e-3));
    const Vector3 about = block.mesh.centreOf(block.middle());
    const Fitted cubic = fitted(block, 3, polynomialOfDegree(3, about, 1e-3), block.allCells());
    expectExact(cubic, 1e-12);
    EXPECT_EQ(cubic.fallbacks, 0);
    const Fitted quartic = fitted(block, 4, polynomialOfDegree(3, about, 1e-3), block.allCells());
    expectExact(quartic, 1e-12);
    EXPECT_EQ(quartic.lowestOrder, 3);
    EXPECT_EQ(quartic.highestOrder, 4);
    EXPECT_EQ(quartic.fallbacks, 8);
    const Potential degree4 = polynomialOfDegree(4, about, 1e-3);
    std::vector<Index> others;
    for (const Index cell : block.allCells()) {
        if (block.mesh.facesOfCell[cell].end() - block.mesh.facesOfCell[cell].begin() < 3) {
            others.push_back(cell);
        }
    }
    const Fitted besides = fitted(block, 4, degree4, others);
    expectExact(besides, 1e-12);
    EXPECT_EQ(besides.fallbacks, 0);
}

TEST(PolynomialGather, goesOnBehindAGroundedWallWithTheMirrorImages)
{
    // Odd about the wall at x = 0, which the other walls, at a voltage and out of reach, are not mirrored with.
    Block block({11, 11, 11}, Vector3(1e-3, 1e-3, 1e-3));
    for (Index face = 0; face < block.mesh.boundary.size(); ++face) {
        if (block.mesh.boundary.normal(face, 0) < -0.5) {
            block.mesh.boundary.value[face] = 0;
        }
    }
    for (const int order : {3, 4}) {
        const Vector3 middle = block.mesh.centreOf(block.middle());
        const Potential odd{[=](const Vector3& place) {
                                const Vector3 x = (place - middle) / 1e-3;
                                const double wall = place[0] / 1e-3;
                                return wall * (3 - 0.7 * x[1] + 0.4 * x[2] + 0.2 * x[1] * x[2] - 0.3 * x[1] * x[1])
                                       + 0.5 * wall * wall * wall * (order == 4 ? 1 + 0.6 * x[2] : 1);
                            },
                            [=](const Vector3& place) -> Vector3 {
                                const Vector3 x = (place - middle) / 1e-3;
                                const double wall = place[0] / 1e-3;
                                const double tilt = order == 4 ? 0.6 : 0;
                                return Vector3(3 - 0.7 * x[1] + 0.4 * x[2] + 0.2 * x[1] * x[2] - 0.3 * x[1] * x[1]
                                                   + 1.5 * wall * wall * (1 + tilt * x[2]),
                                               wall * (-0.7 + 0.2 * x[2] - 0.6 * x[1]),
                                               wall * (0.4 + 0.2 * x[1]) + 0.5 * wall * wall * wall * tilt)
                                       / 1e-3;
                            }};
        const Index cell = 0 + 11 * (5 + 11 * 5);
        const Fitted fit = fitted(block, order, odd, {cell});
        expectExact(fit, 1e-12);
        EXPECT_EQ(fit.lowestOrder, order);
        // The stencil holds mirrored cells, of opposite sign, and no face.
        SurroundingsTable walls(block.mesh, block.cloudRadius);
        PolynomialGather gather(block.mesh, walls, order);
        const auto& points = gather.stencilCells(cell);
        EXPECT_GT(std::count_if(points.begin(), points.end(), [](const auto& point) { return point.sign < 0; }), 10);
        EXPECT_TRUE(gather.stencilFaces(cell).empty());
    }
}

}  // namespace
}  // namespace him
