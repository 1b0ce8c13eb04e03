// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/fake_gas_mesh.hpp"

#include <cmath>

namespace him {

FakeGasMesh::FakeGasMesh(const Box& box, const std::array<Index, 3>& cells, MPI_Comm communicator)
    : box_(box), cells_(cells), communicator_(communicator), slab_(cells[0], communicator)
{
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = box.size()[axis] / static_cast<double>(cells[static_cast<std::size_t>(axis)]);
    }
}

Box FakeGasMesh::localBounds() const
{
    Box bounds = box_;
    bounds.lower[0] = box_.lower[0] + static_cast<double>(slab_.first) * size_[0];
    bounds.upper[0] = box_.lower[0] + static_cast<double>(slab_.last) * size_[0];
    return bounds;
}

Index FakeGasMesh::findCell(const Vector3& point) const
{
    std::array<Index, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        at[a] = static_cast<Index>(std::floor((point[axis] - box_.lower[axis]) / size_[axis]));
        if (at[a] < 0 || at[a] >= cells_[a]) {
            return -1;
        }
    }
    return at[0] < slab_.first || at[0] >= slab_.last ? -1
                                                      : at[2] + cells_[2] * (at[1] + cells_[1] * (at[0] - slab_.first));
}

Vector3 FakeGasMesh::cellCentre(Index cell) const
{
    const Index whole = wholeIndex(cell);
    const Vector3 at(static_cast<double>(whole / (cells_[1] * cells_[2])),
                     static_cast<double>(whole / cells_[2] % cells_[1]), static_cast<double>(whole % cells_[2]));
    return box_.lower + (at + Vector3::Constant(0.5)).cwiseProduct(size_);
}

void FakeGasMesh::smooth(Scalars& perVolume, double length) const
{
    const Index count = cells_[0] * cells_[1] * cells_[2];
    Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
    values.segment(wholeIndex(0), cellCount()) = perVolume.matrix();
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(count), MPI_DOUBLE, MPI_SUM, communicator_);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(count, count);
    const std::array<Index, 3> stride{cells_[1] * cells_[2], cells_[2], 1};
    for (Index cell = 0; cell < count; ++cell) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (cell / stride[axis] % cells_[axis] + 1 < cells_[axis]) {
                const Index other = cell + stride[axis];
                const double weight = 0.25 * length * length / std::pow(size_[static_cast<int>(axis)], 2);
                matrix(cell, cell) += weight;
                matrix(other, other) += weight;
                matrix(cell, other) -= weight;
                matrix(other, cell) -= weight;
            }
        }
    }
    values = matrix.llt().solve(values);
    perVolume = values.segment(wholeIndex(0), cellCount()).array();
}

}  // namespace him
