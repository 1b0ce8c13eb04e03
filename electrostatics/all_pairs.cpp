// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/pair_kernels.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/require.hpp"

#include <array>
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
                         double permittivity, Points& field, Scalars& potential)
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
    const SourceArrays arrays{x.data(), y.data(), z.data(), q.data(), nullptr, nullptr, nullptr};
    const double coulombConstant = 1.0 / (4.0 * pi * permittivity);
    const PairLimits noLimits{std::numeric_limits<double>::max(), 0.0};

    std::int64_t pairs = 0;
    for (Index row = 0; row < targets.rows(); ++row) {
        const Index self = selfRow < 0 ? -1 : selfRow + row;
        const PairTarget target{targets.row(row).matrix(), Vector3::Zero(), 0.0};
        // All rows before and after the target's own, and a spare entry.
        std::array<RowRange, 3> ranges{};
        int count = 0;
        for (const RowRange& range : {RowRange{0, self}, RowRange{self + 1, sources.rows()}}) {
            ranges[count] = range;
            count += range.begin < range.end;
        }
        const PairSum sum = sumCoulomb(arrays, ranges.data(), count, target, noLimits);
        if (sum.coincident) {
            throwSharedPosition(targets, row, sources, self);
        }
        field.row(row) += coulombConstant * sum.field.array().transpose();
        potential[row] += coulombConstant * sum.potential;
        pairs += sum.pairs;
    }
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
