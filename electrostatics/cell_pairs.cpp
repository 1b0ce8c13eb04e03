// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/cell_pairs.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/require.hpp"

#include <algorithm>
#include <stdexcept>

namespace him {

namespace {

/// Appends rows, joined to the range before where nothing lies between.
void append(std::vector<RowRange>& ranges, const RowRange& rows)
{
    if (rows.begin == rows.end) {
        return;
    }
    if (!ranges.empty() && ranges.back().end == rows.begin) {
        ranges.back().end = rows.end;
    } else {
        ranges.push_back(rows);
    }
}

}  // namespace

void ChargesInCells::sumCells(Scalars& cellCharge) const
{
    const auto cells = static_cast<Index>(firstRow.size()) - 1;
    cellCharge.resize(cells);
    for (Index cell = 0; cell < cells; ++cell) {
        const RowRange rows = rowsOf(cell);
        cellCharge[cell] = charge.segment(rows.begin, rows.end - rows.begin).sum();
    }
}

CellPairSum::CellPairSum(double permittivity, const PairKernels& kernels) : kernels_(kernels), permittivity_(permittivity)
{
    requirePositive("permittivity", permittivity);
}

void CellPairSum::load(const ChargesInCells& charges)
{
    const Index rows = charges.position.rows();
    for (Index row = 0; row < rows; ++row) {
        requireFinite("charge", row, charges.charge[row]);
        for (int axis = 0; axis < 3; ++axis) {
            requireFinite("position", row, charges.position(row, axis));
        }
    }
    const auto copy = [rows](const auto& from, Scalars& to) {
        to.setZero(rows + sourcePadding);
        to.head(rows) = from;
    };
    copy(charges.position.col(0), x_);
    copy(charges.position.col(1), y_);
    copy(charges.position.col(2), z_);
    copy(charges.charge, q_);
    for (Scalars* sums : {&fieldX_, &fieldY_, &fieldZ_, &sumOfPotential_}) {
        sums->setZero(rows + sourcePadding);
    }
}

void CellPairSum::collectRanges(const ChargesInCells& charges, Index cell, IndexLists::Row near)
{
    mutual_.clear();
    single_.clear();
    mutual_.push_back(charges.rowsOf(cell));
    for (const std::int32_t other : near) {
        if (other >= charges.ownCells) {
            append(single_, charges.rowsOf(other));
        } else if (other > cell) {
            append(mutual_, charges.rowsOf(other));
        }
    }
}

void CellPairSum::coulomb(const ChargesInCells& charges, const IndexLists& near, PairSumResult& result)
{
    load(charges);
    const PointArrays sources{x_.data(), y_.data(), z_.data(), q_.data(), nullptr, nullptr, nullptr};
    const SumArrays sums{fieldX_.data(), fieldY_.data(), fieldZ_.data(), sumOfPotential_.data()};
    PairLimits limits{};
    limits.cutoffSquared = largestCoordinate * largestCoordinate;
    const PairKernels::Law& law = kernels_.coulomb;

    result.pairs = 0;
    bool coincident = false;
    for (Index cell = 0; cell < charges.ownCells; ++cell) {
        const RowRange rows = charges.rowsOf(cell);
        if (rows.begin == rows.end) {
            continue;
        }
        collectRanges(charges, cell, near[cell]);
        for (std::ptrdiff_t first = rows.begin; first < rows.end; first += mostTargets) {
            const int count = static_cast<int>(std::min<std::ptrdiff_t>(mostTargets, rows.end - first));
            const PointArrays targets = sources.from(first);
            const SumArrays targetSums = sums.from(first);
            PairCount pairs;
            for (int n = 0; n + 1 < count; ++n) {
                const RowRange rest{first + n + 1, first + count};
                pairs += law.mutual(targets.from(n), 1, targetSums.from(n), sources, &rest, 1, limits, sums);
            }
            mutual_.front().begin = first + count;
            const bool none = mutual_.front().begin == mutual_.front().end;
            pairs += law.mutual(targets, count, targetSums, sources, mutual_.data() + (none ? 1 : 0),
                                static_cast<int>(mutual_.size()) - (none ? 1 : 0), limits, sums);
            result.pairs += 2 * pairs.pairs;
            const PairCount oneWay = law.single(targets, count, targetSums, sources, single_.data(),
                                                static_cast<int>(single_.size()), limits);
            result.pairs += oneWay.pairs;
            coincident |= pairs.coincident || oneWay.coincident;
        }
    }
    if (coincident) {
        throw std::domain_error("two charges of near cells share a position");
    }

    const double coulombConstant = 1.0 / (4.0 * pi * permittivity_);
    const Index targets = charges.targets();
    result.resize(targets);
    result.field.col(0) = coulombConstant * fieldX_.head(targets);
    result.field.col(1) = coulombConstant * fieldY_.head(targets);
    result.field.col(2) = coulombConstant * fieldZ_.head(targets);
    result.potential = coulombConstant * sumOfPotential_.head(targets);
}

}  // namespace him
