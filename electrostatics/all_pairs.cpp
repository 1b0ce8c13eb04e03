// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/pair_kernels.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/require.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace him {

namespace {

void requireFiniteRows(const Points& position)
{
    for (Index row = 0; row < position.rows(); ++row) {
        for (int axis = 0; axis < 3; ++axis) {
            requireFinite("position", row, position(row, axis));
        }
    }
}

/// A copy with the padding that the kernels read.
Scalars padded(const Eigen::Ref<const Scalars>& values)
{
    Scalars copy = Scalars::Zero(values.size() + sourcePadding);
    copy.head(values.size()) = values;
    return copy;
}

}  // namespace

std::int64_t addAllPairs(const Points& targets, const Points& sources, const Scalars& charges, Index selfRow,
                         double permittivity, Points& field, Scalars& potential, double cutoff)
{
    requirePositive("permittivity", permittivity);
    if (charges.size() != sources.rows() || field.rows() != targets.rows() || potential.size() != targets.rows()
        || selfRow < -1 || (selfRow >= 0 && selfRow + targets.rows() > sources.rows())) {
        throw std::invalid_argument(
            "addAllPairs: the lengths of targets, sources, charges, field and potential do not match");
    }
    requireFiniteRows(targets);
    requireFiniteRows(sources);
    for (Index row = 0; row < charges.size(); ++row) {
        requireFinite("charge", row, charges[row]);
    }

    const Scalars x = padded(sources.col(0));
    const Scalars y = padded(sources.col(1));
    const Scalars z = padded(sources.col(2));
    const Scalars q = padded(charges);
    const PointArrays arrays{x.data(), y.data(), z.data(), q.data(), nullptr, nullptr, nullptr};
    const Scalars targetX = targets.col(0);
    const Scalars targetY = targets.col(1);
    const Scalars targetZ = targets.col(2);
    const PointArrays targetArrays{targetX.data(), targetY.data(), targetZ.data(), nullptr, nullptr, nullptr, nullptr};
    Points sum = Points::Zero(targets.rows(), 3);
    Scalars sumOfPotential = Scalars::Zero(targets.rows());
    const SumArrays sums{sum.col(0).data(), sum.col(1).data(), sum.col(2).data(), sumOfPotential.data()};
    const PairLimits limits{std::isfinite(cutoff) ? cutoff * cutoff : std::numeric_limits<double>::max(), 0.0, 0.0, {}, {}};
    const PairKernels::Law& law = runnablePairKernels().front()->coulomb;

    std::int64_t pairs = 0;
    for (Index first = 0; first < targets.rows(); first += mostTargets) {
        const int count = static_cast<int>(std::min<Index>(mostTargets, targets.rows() - first));
        const Index self = selfRow + first;
        PairCount found;
        const auto add = [&](Index target, int targetCount, RowRange range) {
            if (range.begin < range.end) {
                found +=
                    law.single(targetArrays.from(target), targetCount, sums.from(target), arrays, &range, 1, limits);
            }
        };
        if (selfRow < 0) {
            add(first, count, {0, sources.rows()});
        } else {
            add(first, count, {0, self});
            add(first, count, {self + count, sources.rows()});
            for (int n = 0; n < count; ++n) {  // the rows of the targets themselves, each without its own
                add(first + n, 1, {self, self + n});
                add(first + n, 1, {self + n + 1, self + count});
            }
        }
        for (int n = 0; found.coincident && n < count; ++n) {
            refuseSharedPosition(targets, first + n, sources, selfRow < 0 ? -1 : self + n);
        }
        pairs += found.pairs;
    }
    const double coulombConstant = 1.0 / (4.0 * pi * permittivity);
    field += coulombConstant * sum;
    potential += coulombConstant * sumOfPotential;
    return pairs;
}

double electrostaticEnergy(const Scalars& charge, const Scalars& potential)
{
    if (charge.size() != potential.size()) {
        throw std::invalid_argument("electrostaticEnergy: charge and potential differ in length");
    }
    return 0.5 * (charge * potential).sum();
}

}  // namespace him
