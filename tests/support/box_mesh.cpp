// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/box_mesh.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace him {

namespace {

/// Matrix of -d2/dx2 [1/m2] on n cells of size h.
Eigen::MatrixXd secondDifference(Index n, double h, bool periodic)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (Index i = 0; i < n; ++i) {
        for (const Index neighbour : {i - 1, i + 1}) {
            const bool wall = !periodic && (neighbour < 0 || neighbour >= n);
            matrix(i, i) += wall ? 2 : 1;
            if (!wall) {
                matrix(i, (neighbour + n) % n) -= 1;
            }
        }
    }
    return matrix / (h * h);
}

}  // namespace

BoxMesh::BoxMesh(const Box& box, const std::array<Index, 3>& cells, double permittivity, MPI_Comm communicator,
                 const std::array<bool, 3>& periodic)
    : box_(box), cells_(cells), periodic_(periodic), permittivity_(permittivity), communicator_(communicator)
{
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        size_[axis] = box.size()[axis] / static_cast<double>(cells[a]);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(secondDifference(cells[a], size_[axis], periodic[a]));
        modes_[a] = solver.eigenvectors();
        eigenvalues_[a] = solver.eigenvalues();
    }
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &ranks);
    first_ = cells[0] * rank / ranks;
    last_ = cells[0] * (rank + 1) / ranks;
    potential_.setZero(cells[0] * cells[1] * cells[2]);
}

Box BoxMesh::localBounds() const
{
    Box bounds;
    if (first_ < last_) {
        bounds = box_;
        bounds.lower[0] = box_.lower[0] + static_cast<double>(first_) * size_[0];
        bounds.upper[0] = box_.lower[0] + static_cast<double>(last_) * size_[0];
    }
    return bounds;
}

Index BoxMesh::findCell(const Vector3& point) const
{
    // A point on a face belongs to the upper cell; on the last face of this rank's slab to the lower one, so that both
    // ranks claim a point on the face between them, as general mesh searches do.
    Indices indices{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double cells = (point[axis] - box_.lower[axis]) / size_[axis];
        const Index begin = axis == 0 ? first_ : 0;
        const Index end = axis == 0 ? last_ : cells_[a];
        if (!(cells >= static_cast<double>(begin) && cells <= static_cast<double>(end)) || begin == end) {
            return -1;
        }
        indices[a] = std::min(static_cast<Index>(std::floor(cells)), end - 1);
    }
    return indices[0] - first_ + (last_ - first_) * (indices[1] + cells_[1] * indices[2]);
}

BoxMesh::Indices BoxMesh::indicesOf(Index cell) const
{
    const Index slab = last_ - first_;
    return {first_ + cell % slab, (cell / slab) % cells_[1], cell / (slab * cells_[1])};
}

Vector3 BoxMesh::cellCentre(Index cell) const
{
    const Indices indices = indicesOf(cell);
    const Vector3 cells(static_cast<double>(indices[0]), static_cast<double>(indices[1]), static_cast<double>(indices[2]));
    return box_.lower + (cells + Vector3::Constant(0.5)).cwiseProduct(size_);
}

void BoxMesh::transform(Scalars& values, bool back) const
{
    const auto [nx, ny, nz] = cells_;
    const auto mode = [&](std::size_t axis) { return back ? modes_[axis] : Eigen::MatrixXd(modes_[axis].transpose()); };
    Eigen::Map<Eigen::MatrixXd> alongX(values.data(), nx, ny * nz);
    alongX = (mode(0) * alongX).eval();
    const Eigen::MatrixXd modesY = mode(1).transpose();
    for (Index k = 0; k < nz; ++k) {
        Eigen::Map<Eigen::MatrixXd> plane(values.data() + nx * ny * k, nx, ny);
        plane = (plane * modesY).eval();
    }
    Eigen::Map<Eigen::MatrixXd> alongZ(values.data(), nx * ny, nz);
    alongZ = (alongZ * mode(2).transpose()).eval();
}

void BoxMesh::solve(const Scalars& cellCharge)
{
    potential_.setZero();
    for (Index cell = 0; cell < cellCharge.size(); ++cell) {
        const Indices indices = indicesOf(cell);
        potential_[indices[0] + cells_[0] * (indices[1] + cells_[1] * indices[2])] = cellCharge[cell];
    }
    MPI_Allreduce(MPI_IN_PLACE, potential_.data(), static_cast<int>(potential_.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    chargeOnMesh_ = potential_.sum();

    transform(potential_, false);
    Index n = 0;
    for (Index k = 0; k < cells_[2]; ++k) {
        for (Index j = 0; j < cells_[1]; ++j) {
            for (Index i = 0; i < cells_[0]; ++i, ++n) {
                potential_[n] /= permittivity_ * cellVolume() * (eigenvalues_[0][i] + eigenvalues_[1][j] + eigenvalues_[2][k]);
            }
        }
    }
    transform(potential_, true);
}

Vector3 BoxMesh::electricField(Index cell) const
{
    const Indices here = indicesOf(cell);
    Vector3 field;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        double face[2] = {0, 0};  // potential of the lower and upper face; a wall is at 0 V
        for (const int side : {0, 1}) {
            Indices neighbour = here;
            neighbour[a] += 2 * side - 1;
            if (periodic_[a]) {
                neighbour[a] = (neighbour[a] + cells_[a]) % cells_[a];
            }
            if (neighbour[a] >= 0 && neighbour[a] < cells_[a]) {
                face[side] = 0.5 * (at(here) + at(neighbour));
            }
        }
        field[axis] = (face[0] - face[1]) / size_[axis];
    }
    return field;
}

double BoxMesh::potential(Index cell) const { return at(indicesOf(cell)); }

}  // namespace him
