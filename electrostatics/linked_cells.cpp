// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/linked_cells.hpp"

#include "electrostatics/point_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace him {

namespace {

/// Cells per point at most; where the reach asks for more, cells grow until they fit.
constexpr double cellsPerPoint = 4.0;

Box boundsOf(const Points& position, Index firstRow, Index rows)
{
    Box bounds;
    for (Index row = firstRow; row < firstRow + rows; ++row) {
        const Vector3 point = position.row(row).matrix();
        for (const double coordinate : point) {
            requireFinite("position", row, coordinate);
        }
        bounds.extend(point);
    }
    return bounds;
}

}  // namespace

int LinkedCells::cellsPerReach(const Vector3& extent, Index points, double pointsPerReach) const
{
    // As many points in a row of cells as the reach is long, wherever points are evenly spread.
    const double reaches = (extent.array() / reach_).max(1.0).prod();
    const double fitting = std::sqrt(static_cast<double>(points) / (reaches * pointsPerReach));
    return static_cast<int>(std::round(std::min(std::max(fitting, 1.0), double(mostCellsPerReach))));
}

void LinkedCells::layOut(const Box& bounds, double reach, Index points, double pointsPerReach)
{
    const double largest = bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).maxCoeff();
    margin_ = 1e-12 * reach + 32.0 * std::numeric_limits<double>::epsilon() * largest;
    reach_ = reach + margin_;
    origin_ = bounds.lower;

    const Vector3 extent = bounds.size();
    const double across = reach_ / cellsPerReach(extent, points, pointsPerReach);
    const Vector3 finest(reach_ / cellsPerReachAlong, across, across);
    const double allowed = cellsPerPoint * static_cast<double>(points);
    double growth = 1.0;
    while (true) {
        Vector3 count;
        for (int axis = 0; axis < 3; ++axis) {
            const double fitting = std::floor(extent[axis] / (finest[axis] * growth));
            count[axis] = std::min(std::max(fitting, 1.0), 2.0 * allowed);  // more is too many whatever the other axes
        }
        const double excess = count.prod() / allowed;
        if (excess <= 1.0) {
            for (int axis = 0; axis < 3; ++axis) {
                count_[axis] = static_cast<Index>(count[axis]);
                cellSize_[axis] = std::max(extent[axis] / count[axis], finest[axis] * growth);
                cellsPerMetre_[axis] = 1.0 / cellSize_[axis];
            }
            return;
        }
        growth *= std::max(std::cbrt(excess), 1.05);
    }
}

Index LinkedCells::cellAlong(int axis, double coordinate) const
{
    // Monotone in the coordinate, round-off included: a range of coordinates maps to a range of cells.
    const double cell = (coordinate - origin_[axis]) * cellsPerMetre_[axis];
    const double last = static_cast<double>(count_[axis] - 1);
    return static_cast<Index>(cell > 0.0 ? (cell < last ? cell : last) : 0.0);
}

double LinkedCells::distanceToSlab(int axis, Index slab, const Box& box) const
{
    const double lower = origin_[axis] + static_cast<double>(slab) * cellSize_[axis];
    return std::max({0.0, lower - box.upper[axis], box.lower[axis] - (lower + cellSize_[axis])});
}

void LinkedCells::build(const Points& position, Index firstRow, Index rows, double reach, double pointsPerReach)
{
    if (firstRow + rows >= std::numeric_limits<std::int32_t>::max() / static_cast<Index>(cellsPerPoint)) {
        throw std::length_error("more points on one rank than 32-bit linked cells can hold");
    }
    order_.resize(static_cast<std::size_t>(rows));
    cellOfPoint_.resize(static_cast<std::size_t>(rows));
    if (rows == 0) {
        return;
    }
    layOut(boundsOf(position, firstRow, rows), reach, rows, pointsPerReach);

    cellStart_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2] + 1), 0);
    for (Index i = 0; i < rows; ++i) {
        const Index ix = cellAlong(0, position(firstRow + i, 0));
        const Index iy = cellAlong(1, position(firstRow + i, 1));
        const Index iz = cellAlong(2, position(firstRow + i, 2));
        const Index cell = (iz * count_[1] + iy) * count_[0] + ix;
        cellOfPoint_[i] = static_cast<std::int32_t>(cell);
        ++cellStart_[cell];
    }
    // Ends of the cells, which the scatter turns into starts by filling every cell from its back.
    for (std::size_t cell = 1; cell < cellStart_.size(); ++cell) {
        cellStart_[cell] += cellStart_[cell - 1];
    }
    for (Index i = rows - 1; i >= 0; --i) {
        order_[--cellStart_[cellOfPoint_[i]]] = static_cast<std::int32_t>(firstRow + i);
    }
}

void LinkedCells::rangesAround(const Box& box, Ranges& out) const
{
    collect(box, cellAlong(2, box.lower.z() - reach_), 0, out);
}

void LinkedCells::rangesFrom(Index firstPlace, const Box& box, Ranges& out) const
{
    collect(box, cellAlong(2, box.lower.z()), firstPlace, out);
}

void LinkedCells::collect(const Box& box, Index firstSlab, Index firstPlace, Ranges& out) const
{
    out.count = 0;
    if (order_.empty()) {
        return;
    }
    const Index lastSlab = cellAlong(2, box.upper.z() + reach_);
    for (Index iz = firstSlab; iz <= lastSlab; ++iz) {
        const double dz = distanceToSlab(2, iz, box);
        const double squaredWidth = std::max(reach_ * reach_ - dz * dz, 0.0);
        const double halfWidth = std::sqrt(squaredWidth) + margin_;
        const Index firstRow = cellAlong(1, box.lower.y() - halfWidth);
        const Index lastRow = cellAlong(1, box.upper.y() + halfWidth);
        for (Index iy = firstRow; iy <= lastRow; ++iy) {
            const double dy = distanceToSlab(1, iy, box);
            const double halfLength = std::sqrt(std::max(squaredWidth - dy * dy, 0.0)) + margin_;
            const Index row = (iz * count_[1] + iy) * count_[0];
            const Index begin = cellStart_[row + cellAlong(0, box.lower.x() - halfLength)];
            const Index end = cellStart_[row + cellAlong(0, box.upper.x() + halfLength) + 1];
            out.range[out.count] = {std::max(begin, firstPlace), end};
            out.count += out.range[out.count].begin < end;
        }
    }
}

}  // namespace him
