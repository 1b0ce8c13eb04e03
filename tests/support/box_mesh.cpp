// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/box_mesh.hpp"

#include "electrostatics/p3m/lattice_operator.hpp"

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
    : box_(box),
      cells_(cells),
      periodic_(periodic),
      permittivity_(permittivity),
      communicator_(communicator),
      slab_(cells[0], communicator)
{
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        size_[axis] = box.size()[axis] / static_cast<double>(cells[a]);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
            secondDifference(cells[a], size_[axis], periodic[a]));
        modes_[a] = solver.eigenvectors();
        eigenvalues_[a] = solver.eigenvalues();
    }
    potential_.setZero(cells[0] * cells[1] * cells[2]);
    makeArrays();
}

std::vector<Box> BoxMesh::cellBoxes() const
{
    std::vector<Box> boxes;
    for (Index cell = 0; cell < cellCount(); ++cell) {
        boxes.push_back({cellCentre(cell) - 0.5 * size_, cellCentre(cell) + 0.5 * size_});
    }
    return boxes;
}

void BoxMesh::chargeWall(Index plane, double height, const std::function<double(const Vector3&)>& density)
{
    std::vector<double> charges;
    for (Index cell = 0; cell < cellCount(); ++cell) {
        const Vector3 centre = cellCentre(cell) + 0.5 * size_[0] * Vector3::UnitX();
        if (indicesOf(cell)[0] != plane || centre[2] - box_.lower[2] > height) {
            continue;
        }
        const Vector3 y = 0.5 * size_[1] * Vector3::UnitY();
        const Vector3 z = 0.5 * size_[2] * Vector3::UnitZ();
        chargedFaces_.push_back(
            {{centre - y - z, centre + y - z, centre + y + z, centre - y + z}, static_cast<std::int32_t>(cell)});
        charges.push_back(density(centre) * size_[1] * size_[2]);
    }
    faceCharge_ = Eigen::Map<const Scalars>(charges.data(), static_cast<Index>(charges.size()));
}

void BoxMesh::makeArrays()
{
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(communicator_, &rank);
    MPI_Comm_size(communicator_, &ranks);
    const Index slab = slab_.last - slab_.first;
    const Index count = slab * cells_[1] * cells_[2];
    arrays_.centre.resize(count, 3);
    arrays_.volume.setConstant(count, cellVolume());
    arrays_.radius.setConstant(count, 0.5 * size_.norm());
    std::vector<Vector3> internal, internalArea, boundary, normal, coupled, coupledArea, shift;
    const auto rankOf = [&](Index i) {
        int r = 0;
        while (i >= cells_[0] * (r + 1) / ranks) {
            ++r;
        }
        return r;
    };
    for (Index cell = 0; cell < count; ++cell) {
        arrays_.centre.row(cell) = cellCentre(cell).transpose().array();
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
                const auto a = static_cast<std::size_t>(axis);
                Indices other = indicesOf(cell);
                other[a] += side;
                const Vector3 faceCentre = cellCentre(cell) + 0.5 * side * size_[axis] * Vector3::Unit(axis);
                const Vector3 area = side * (cellVolume() / size_[axis]) * Vector3::Unit(axis);
                Vector3 step = Vector3::Zero();
                if (other[a] < 0 || other[a] >= cells_[a]) {
                    if (!periodic_[a]) {
                        boundary.push_back(faceCentre);
                        normal.push_back(side * Vector3::Unit(axis));
                        arrays_.boundary.cell.push_back(static_cast<std::int32_t>(cell));
                        arrays_.boundary.condition.push_back(FaceCondition::conductor);
                        continue;
                    }
                    other[a] = (other[a] + cells_[a]) % cells_[a];
                    step[axis] = side * box_.size()[axis];
                }
                const int otherRank = rankOf(other[0]);
                const Index otherFirst = cells_[0] * otherRank / ranks;
                const Index otherSlab = cells_[0] * (otherRank + 1) / ranks - otherFirst;
                const Index otherCell = other[0] - otherFirst + otherSlab * (other[1] + cells_[1] * other[2]);
                if (otherRank == rank && step.isZero(0)) {
                    if (side > 0) {
                        internal.push_back(faceCentre);
                        internalArea.push_back(area);
                        arrays_.internal.owner.push_back(static_cast<std::int32_t>(cell));
                        arrays_.internal.neighbour.push_back(static_cast<std::int32_t>(otherCell));
                    }
                    continue;
                }
                coupled.push_back(faceCentre);
                coupledArea.push_back(area);
                shift.push_back(step);
                arrays_.coupled.cell.push_back(static_cast<std::int32_t>(cell));
                arrays_.coupled.otherRank.push_back(otherRank);
                arrays_.coupled.otherCell.push_back(static_cast<std::int32_t>(otherCell));
            }
        }
    }
    const auto toPoints = [](const std::vector<Vector3>& from) {
        Points points(static_cast<Index>(from.size()), 3);
        for (std::size_t n = 0; n < from.size(); ++n) {
            points.row(static_cast<Index>(n)) = from[n].transpose().array();
        }
        return points;
    };
    arrays_.internal.centre = toPoints(internal);
    arrays_.internal.areaVector = toPoints(internalArea);
    arrays_.boundary.centre = toPoints(boundary);
    arrays_.boundary.normal = toPoints(normal);
    arrays_.boundary.area.resize(arrays_.boundary.size());
    arrays_.boundary.radius.resize(arrays_.boundary.size());
    arrays_.boundary.value.setZero(arrays_.boundary.size());
    for (Index face = 0; face < arrays_.boundary.size(); ++face) {
        const Vector3 n = normal[static_cast<std::size_t>(face)].cwiseAbs();
        arrays_.boundary.area[face] = cellVolume() / n.dot(size_);
        arrays_.boundary.radius[face] = 0.5 * (size_ - n.cwiseProduct(size_)).norm();
    }
    arrays_.coupled.centre = toPoints(coupled);
    arrays_.coupled.areaVector = toPoints(coupledArea);
    arrays_.coupled.shift = toPoints(shift);
}

Box BoxMesh::localBounds() const
{
    Box bounds;
    if (slab_.first < slab_.last) {
        bounds = box_;
        bounds.lower[0] = box_.lower[0] + static_cast<double>(slab_.first) * size_[0];
        bounds.upper[0] = box_.lower[0] + static_cast<double>(slab_.last) * size_[0];
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
        const Index begin = axis == 0 ? slab_.first : 0;
        const Index end = axis == 0 ? slab_.last : cells_[a];
        if (!(cells >= static_cast<double>(begin) && cells <= static_cast<double>(end)) || begin == end) {
            return -1;
        }
        indices[a] = std::min(static_cast<Index>(std::floor(cells)), end - 1);
    }
    return indices[0] - slab_.first + (slab_.last - slab_.first) * (indices[1] + cells_[1] * indices[2]);
}

BoxMesh::Indices BoxMesh::indicesOf(Index cell) const
{
    const Index slab = slab_.last - slab_.first;
    return {slab_.first + cell % slab, (cell / slab) % cells_[1], cell / (slab * cells_[1])};
}

Vector3 BoxMesh::cellCentre(Index cell) const
{
    const Indices indices = indicesOf(cell);
    const Vector3 cells(static_cast<double>(indices[0]), static_cast<double>(indices[1]),
                        static_cast<double>(indices[2]));
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

Scalars BoxMesh::gathered(const Scalars& ownValues) const
{
    Scalars all = Scalars::Zero(potential_.size());
    for (Index cell = 0; cell < ownValues.size(); ++cell) {
        const Indices indices = indicesOf(cell);
        all[indices[0] + cells_[0] * (indices[1] + cells_[1] * indices[2])] = ownValues[cell];
    }
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    return all;
}

void BoxMesh::solveWhole(Scalars& values, bool matched) const
{
    const auto eigenvalue = [&](std::size_t axis, Index n) {
        const double h = size_[static_cast<Index>(axis)];
        const double second = eigenvalues_[axis][n];
        return matched ? matchedSymbol(std::acos(std::max(-1.0, 1 - 0.5 * second * h * h))) / (h * h) : second;
    };
    transform(values, false);
    Index n = 0;
    for (Index k = 0; k < cells_[2]; ++k) {
        for (Index j = 0; j < cells_[1]; ++j) {
            for (Index i = 0; i < cells_[0]; ++i, ++n) {
                values[n] /= permittivity_ * cellVolume() * (eigenvalue(0, i) + eigenvalue(1, j) + eigenvalue(2, k));
            }
        }
    }
    transform(values, true);
}

void BoxMesh::solve(const Scalars& cellCharge)
{
    potential_ = gathered(cellCharge);
    chargeOnMesh_ = potential_.sum();
    solveWhole(potential_, false);
}

void BoxMesh::solve(const Scalars& cellCharge, const Scalars& boundaryValue)
{
    Scalars source = cellCharge;
    for (Index face = 0; face < arrays_.boundary.size(); ++face) {
        const Vector3 n = arrays_.boundary.normal.row(face).matrix().transpose().cwiseAbs();
        source[arrays_.boundary.cell[static_cast<std::size_t>(face)]] +=
            permittivity_ * arrays_.boundary.area[face] * boundaryValue[face] / (0.5 * n.dot(size_));
    }
    potential_ = gathered(source);
    chargeOnMesh_ = gathered(cellCharge).sum();
    solveWhole(potential_, matched_);
}

void BoxMesh::correct(const Scalars& residual)
{
    Scalars change = gathered(residual);
    solveWhole(change, false);
    potential_ += change;
}

bool BoxMesh::useMatchedOperator()
{
    matched_ = direct && !periodic_[0] && !periodic_[1] && !periodic_[2];
    return matched_;
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

double BoxMesh::potential(Index cell) const
{
    return at(indicesOf(cell));
}

}  // namespace him
