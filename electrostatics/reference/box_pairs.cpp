// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/point_checks.hpp"
#include "electrostatics/reference/box_sums.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

/// Charges in the order of a grid of cells over the box; the cells along z of one column follow each other.
class SourceGrid {
public:
    SourceGrid(const BoxSum& sum, double cutoff)
    {
        const Index count = sum.position.rows();
        // A quarter of the cutoff wastes few pairs; no more than about one cell per two charges.
        const double volume = sum.axes[0].length() * sum.axes[1].length() * sum.axes[2].length();
        const double width = std::max(0.25 * cutoff, std::cbrt(2 * volume / static_cast<double>(count + 1)));
        for (std::size_t a = 0; a < 3; ++a) {
            cells_[a] = std::max<Index>(1, static_cast<Index>(sum.axes[a].length() / width));
            size_[a] = sum.axes[a].length() / static_cast<double>(cells_[a]);
        }
        std::vector<Index> cellOf(static_cast<std::size_t>(count));
        begin.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
        for (Index from = 0; from < count; ++from) {
            const Index cell = column(cellAlong(0, sum.position(from, 0)), cellAlong(1, sum.position(from, 1)))
                               + cellAlong(2, sum.position(from, 2));
            cellOf[static_cast<std::size_t>(from)] = cell;
            ++begin[static_cast<std::size_t>(cell) + 1];
        }
        for (std::size_t cell = 1; cell < begin.size(); ++cell) {
            begin[cell] += begin[cell - 1];
        }
        std::vector<Index> next(begin.begin(), begin.end() - 1);
        row.resize(static_cast<std::size_t>(count));
        x.resize(count);
        y.resize(count);
        z.resize(count);
        q.resize(count);
        for (Index from = 0; from < count; ++from) {
            const Index to = next[static_cast<std::size_t>(cellOf[static_cast<std::size_t>(from)])]++;
            row[static_cast<std::size_t>(to)] = from;
            x[to] = sum.position(from, 0);
            y[to] = sum.position(from, 1);
            z[to] = sum.position(from, 2);
            q[to] = sum.charge[from];
        }
    }

    Index cellAlong(std::size_t axis, double position) const
    {
        return std::clamp<Index>(static_cast<Index>(std::floor(position / size_[axis])), 0, cells_[axis] - 1);
    }
    Index column(Index cellX, Index cellY) const { return cells_[2] * (cellY + cells_[1] * cellX); }
    /// Distance [m] of a coordinate from the cells with that number.
    double distance(std::size_t axis, Index cell, double position) const
    {
        const double lower = static_cast<double>(cell) * size_[axis];
        return std::max({0.0, lower - position, position - lower - size_[axis]});
    }

    std::vector<Index> begin;  ///< first charge of each cell, and the number of charges
    std::vector<Index> row;    ///< where each charge was
    Scalars x, y, z, q;

private:
    std::array<Index, 3> cells_;
    std::array<double, 3> size_;
};

[[noreturn]] void throwShared(const BoxSum& sum, Index target, Index row, bool itself)
{
    std::ostringstream text;
    text << "target " << target << " at " << pointText(sum.targets.row(target).matrix())
         << " from the corner of the box " << (itself ? "shares the position of charge " : "meets an image of charge ")
         << row << "; its field would be infinite";
    throw std::domain_error(text.str());
}

struct Total {
    double potential = 0, x = 0, y = 0, z = 0;
};

/// One target against one image of everything, seen as the image of the target against the charges as they are.
class TargetSum {
public:
    TargetSum(const BoxSum& sum, const EwaldKernel& kernel, double cutoff)
        : sum_(sum), kernel_(kernel), cutoff_(cutoff), grid_(sum, cutoff)
    {
    }

    Total operator()(Index target)
    {
        for (std::size_t a = 0; a < 3; ++a) {
            sum_.axes[a].images(sum_.targets(target, static_cast<Index>(a)), cutoff_, images_[a]);
        }
        Total total;
        for (const BoxAxis::Image& x : images_[0]) {
            for (const BoxAxis::Image& y : images_[1]) {
                for (const BoxAxis::Image& z : images_[2]) {
                    const bool itself = &x == images_[0].data() && &y == images_[1].data() && &z == images_[2].data();
                    const Total part = seenFrom({x.position, y.position, z.position}, target, itself);
                    const double sign = x.sign * y.sign * z.sign;
                    total.potential += sign * part.potential;
                    total.x += sign * x.direction * part.x;
                    total.y += sign * y.direction * part.y;
                    total.z += sign * z.direction * part.z;
                }
            }
        }
        return total;
    }

private:
    Total seenFrom(const std::array<double, 3>& point, Index target, bool itself) const
    {
        Total total;
        const Index lastX = grid_.cellAlong(0, point[0] + cutoff_);
        const Index lastY = grid_.cellAlong(1, point[1] + cutoff_);
        for (Index cellX = grid_.cellAlong(0, point[0] - cutoff_); cellX <= lastX; ++cellX) {
            const double dx = grid_.distance(0, cellX, point[0]);
            for (Index cellY = grid_.cellAlong(1, point[1] - cutoff_); cellY <= lastY; ++cellY) {
                const double dy = grid_.distance(1, cellY, point[1]);
                const double left = cutoff_ * cutoff_ - dx * dx - dy * dy;
                if (left < 0) {
                    continue;
                }
                const double reach = std::sqrt(left);
                const Index column = grid_.column(cellX, cellY);
                const Index first = column + grid_.cellAlong(2, point[2] - reach);
                const Index last = column + grid_.cellAlong(2, point[2] + reach);
                addRange(grid_.begin[static_cast<std::size_t>(first)], grid_.begin[static_cast<std::size_t>(last) + 1],
                         point, target, itself, total);
            }
        }
        return total;
    }

    void addRange(Index begin, Index end, const std::array<double, 3>& point, Index target, bool itself,
                  Total& total) const
    {
        const double cutoffSquare = cutoff_ * cutoff_;
        for (Index n = begin; n < end; ++n) {
            const double dx = point[0] - grid_.x[n];
            const double dy = point[1] - grid_.y[n];
            const double dz = point[2] - grid_.z[n];
            const double square = dx * dx + dy * dy + dz * dz;
            if (square > cutoffSquare) {
                continue;
            }
            if (square == 0) {
                const Index row = grid_.row[static_cast<std::size_t>(n)];
                if (itself && row == sum_.ownRow[static_cast<std::size_t>(target)]) {
                    continue;
                }
                throwShared(sum_, target, row, itself);
            }
            double potential = 0;
            double field = 0;
            kernel_.evaluate(std::sqrt(square), potential, field);
            total.potential += grid_.q[n] * potential;
            field *= grid_.q[n];
            total.x += field * dx;
            total.y += field * dy;
            total.z += field * dz;
        }
    }

    const BoxSum& sum_;
    const EwaldKernel& kernel_;
    double cutoff_;
    SourceGrid grid_;
    std::array<std::vector<BoxAxis::Image>, 3> images_;
};

}  // namespace

void addScreenedPairs(const BoxSum& sum, const EwaldKernel& kernel, double cutoff, Points& field, Scalars& potential)
{
    TargetSum sumAt(sum, kernel, cutoff);
    for (Index target = 0; target < sum.targets.rows(); ++target) {
        const Total total = sumAt(target);
        potential[target] += total.potential;
        field(target, 0) += total.x;
        field(target, 1) += total.y;
        field(target, 2) += total.z;
    }
}

}  // namespace him
