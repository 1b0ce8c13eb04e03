// SPDX-License-Identifier: GPL-3.0-or-later
// NearField::screened in single precision.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"

#include <algorithm>

namespace him {

namespace {

/// As in double precision, but with fewer and longer rows of linked cells, which are gathered once for two groups of
/// targets: measured the fastest from 50 to 2000 neighbours.
constexpr double pointsPerReach = 20.0;
constexpr double blockLength = 0.5;
constexpr int mostTogether = 2 * mostTargets;

}  // namespace

void NearField::screenedInSingle(const ChargedPoints& points, const ChargeCloud& cloud, PairSumResult& result)
{
    sort(points, false, pointsPerReach);
    const PairKernels::SingleLaw& law = kernels_.screenedInSingle[cloud.exponent() - 1];
    const Index targets = points.targets;
    const double largest = points.charge.size() == 0 ? 0.0 : points.charge.abs().maxCoeff();
    const double unit = largest > 0 ? largest : 1.0;
    single_.start(q_.data(), points.position.rows(), unit, targets);
    const float* charge = single_.charge.data();
    const PointArrays targetRows{x_.data(), y_.data(), z_.data(), q_.data(), nullptr, nullptr, nullptr};
    const PointArrays otherRows = targetRows.from(targets);
    // Lengths in cutoffs: the cloud has the radius 1.
    PairLimits limits{1.0, 0.0, 1.0, {}, {}};
    for (std::size_t n = 0; n < 4; ++n) {
        limits.cloudPotential[n] = cloud.coefficients().potential[n] * cutoff_;
    }
    for (std::size_t n = 0; n < 3; ++n) {
        limits.cloudField[n] = cloud.coefficients().field[n] * cutoff_ * cutoff_ * cutoff_;
    }

    result.pairs = 0;
    LinkedCells::Ranges later, around;
    for (Index row = 0; row < targets_.rowCount(); ++row) {
        const Index end = targets_.rowBegin(row + 1);
        for (Index first = targets_.rowBegin(row); first < end;) {
            const TargetBlock block = blockFrom(first, end, mostTogether, blockLength);
            const RowRange own{first, first + block.count};
            targets_.rangesFrom(own.end, block.box, later);
            around.count = 0;
            if (others_.size() > 0) {
                others_.rangesAround(block.box, around);
            }
            const Vector3 centre = 0.5 * (block.box.lower + block.box.upper);
            gathered_.begin(block.count + later.places() + around.places(), 3, centre, cutoff_);
            gathered_.append(own, targetRows, charge);
            gathered_.pad();
            const Index mutualBegin = gathered_.size();
            for (int n = 0; n < later.count; ++n) {
                gathered_.append(later.range[static_cast<std::size_t>(n)], targetRows, charge);
            }
            const Index mutualEnd = gathered_.size();
            gathered_.pad();
            const Index oneSidedBegin = gathered_.size();
            for (int n = 0; n < around.count; ++n) {
                gathered_.append(around.range[static_cast<std::size_t>(n)], otherRows, charge + targets);
            }
            const Index oneSidedEnd = gathered_.size();
            gathered_.pad();
            const GatheredPoints rows = gathered_.finish(oneSidedBegin);
            // Every pair of targets once, for both, first those inside the block; the other sources act one-sided.
            PairCount count, oneSided;
            for (int n = 0; n + 1 < block.count; ++n) {
                count += law.mutual(rows.from(n), 1, rows, n + 1, block.count, limits);
            }
            for (int n = 0; n < block.count; n += mostTargets) {
                const int together = std::min(mostTargets, block.count - n);
                count += law.mutual(rows.from(n), together, rows, mutualBegin, mutualEnd, limits);
                oneSided += law.single(rows.from(n), together, rows, oneSidedBegin, oneSidedEnd, limits);
            }
            result.pairs += 2 * count.pairs + oneSided.pairs;
            if (count.coincident || oneSided.coincident) {
                refuseCoincidence(points, block);
            }
            gathered_.addTo(own, 0, single_);
            Index from = mutualBegin;
            for (int n = 0; n < later.count; ++n) {
                const RowRange& range = later.range[static_cast<std::size_t>(n)];
                gathered_.addTo(range, from, single_);
                from += range.end - range.begin;
            }
            first = own.end;
        }
    }

    const double potentialUnit = unit / (4.0 * pi * permittivity_ * cutoff_);
    const double fieldUnit = potentialUnit / cutoff_;
    result.resize(targets);
    for (Index place = 0; place < targets; ++place) {
        const auto p = static_cast<std::size_t>(place);
        const Index row = targets_.order()[p];
        result.field(row, 0) = fieldUnit * double(single_.fieldX[p]);
        result.field(row, 1) = fieldUnit * double(single_.fieldY[p]);
        result.field(row, 2) = fieldUnit * double(single_.fieldZ[p]);
        result.potential[row] = potentialUnit * double(single_.potential[p]);
    }
}

}  // namespace him
