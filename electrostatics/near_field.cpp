// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/near_field.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/require.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace him {

namespace {

/// Cells whose centres are closer than this share of the cutoff are one cell, so that round-off in a centre cannot turn
/// into a field.
constexpr double sameCellShare = 1e-9;

constexpr double shortestCutoff = 1e-40;  ///< [m], far enough above smallestDistance

/// Room for `count` values and the padding. Grows only, with some slack, and keeps the padding readable and finite.
void reserveRows(Scalars& values, Index count)
{
    if (values.size() < count + sourcePadding) {
        values.setZero(count + count / 8 + sourcePadding);
    }
}

void requireMatching(const ChargedPoints& points, bool withCellCentres)
{
    const Index rows = points.position.rows();
    const auto refuse = [rows](const char* what, Index found) {
        throw std::invalid_argument(std::string(what) + " must match the " + std::to_string(rows) + " positions, found "
                                    + std::to_string(found));
    };
    if (points.charge.size() != rows) {
        refuse("the number of charges", points.charge.size());
    }
    if (withCellCentres && points.cellCentre.rows() != rows) {
        refuse("the number of cell centres", points.cellCentre.rows());
    }
    if (points.targets < 0 || points.targets > rows) {
        throw std::invalid_argument("the number of targets must lie between 0 and the " + std::to_string(rows)
                                    + " positions, found " + std::to_string(points.targets));
    }
}

/// Points in one reach of a row of linked cells, and how far apart targets may lie that are summed together, as a share of
/// the cutoff.
constexpr double pointsPerReach = 8.0;
constexpr double blockLength = 0.35;

}  // namespace

NearField::NearField(double cutoff, double permittivity, const PairKernels& kernels)
    : kernels_(kernels), cutoff_(cutoff), permittivity_(permittivity)
{
    if (!std::isgreaterequal(cutoff, shortestCutoff) || !std::islessequal(cutoff, largestCoordinate)) {
        rejectArgument("near cutoff [m]", "> 0 (1e-40 to 1e50)", cutoff);
    }
    requirePositive("permittivity", permittivity);
}

void NearField::sort(const ChargedPoints& points, bool withCellCentres, double pointsPerReach)
{
    requireMatching(points, withCellCentres);
    const Index rows = points.position.rows();
    targets_.build(points.position, 0, points.targets, cutoff_, pointsPerReach);
    others_.build(points.position, points.targets, rows - points.targets, cutoff_, pointsPerReach);

    for (Scalars* values : {&x_, &y_, &z_, &q_, &fieldX_, &fieldY_, &fieldZ_, &sumOfPotential_}) {
        reserveRows(*values, rows);
    }
    if (withCellCentres) {
        for (Scalars* values : {&cellX_, &cellY_, &cellZ_}) {
            reserveRows(*values, rows);
        }
    }
    Index place = 0;
    for (const LinkedCells* cells : {&targets_, &others_}) {
        for (const Index row : cells->order()) {
            requireFinite("charge", row, points.charge[row]);
            x_[place] = points.position(row, 0);
            y_[place] = points.position(row, 1);
            z_[place] = points.position(row, 2);
            q_[place] = points.charge[row];
            if (withCellCentres) {
                for (int axis = 0; axis < 3; ++axis) {
                    requireFinite("cell centre", row, points.cellCentre(row, axis));
                }
                cellX_[place] = points.cellCentre(row, 0);
                cellY_[place] = points.cellCentre(row, 1);
                cellZ_[place] = points.cellCentre(row, 2);
            }
            ++place;
        }
    }
}

PairLimits NearField::limits() const
{
    const double squared = cutoff_ * cutoff_;
    return {squared, sameCellShare * sameCellShare * squared, 1.0 / squared, {}, {}};
}

NearField::TargetBlock NearField::blockFrom(Index first, Index end, int most, double length) const
{
    TargetBlock block{first, 0, Box()};
    for (Index place = first; place < std::min<Index>(end, first + most); ++place) {
        Box grown = block.box;
        grown.extend({x_[place], y_[place], z_[place]});
        if (block.count > 0 && grown.upper.x() - grown.lower.x() > length * cutoff_) {
            break;
        }
        block.box = grown;
        ++block.count;
    }
    return block;
}

void NearField::sumAtTargets(const ChargedPoints& points, const PairKernels::Law& law, const PairLimits& limits,
                             PairSumResult& result)
{
    const Index targets = points.targets;
    const PointArrays sources{x_.data(), y_.data(), z_.data(), q_.data(), cellX_.data(), cellY_.data(), cellZ_.data()};
    const PointArrays others = sources.from(targets);
    const SumArrays sums{fieldX_.data(), fieldY_.data(), fieldZ_.data(), sumOfPotential_.data()};
    for (Scalars* values : {&fieldX_, &fieldY_, &fieldZ_, &sumOfPotential_}) {
        values->head(targets + sourcePadding).setZero();
    }

    result.pairs = 0;
    LinkedCells::Ranges ranges;
    for (Index row = 0; row < targets_.rowCount(); ++row) {
        const Index end = targets_.rowBegin(row + 1);
        for (Index first = targets_.rowBegin(row); first < end;) {
            const TargetBlock block = blockFrom(first, end, mostTargets, blockLength);
            const PointArrays blockPoints = sources.from(first);
            const SumArrays blockSums = sums.from(first);
            // Every pair of targets once, for both, first those inside the block; the other sources act one-sided.
            PairCount count;
            for (int n = 0; n + 1 < block.count; ++n) {
                const RowRange rest{first + n + 1, first + block.count};
                count += law.mutual(blockPoints.from(n), 1, blockSums.from(n), sources, &rest, 1, limits, sums);
            }
            targets_.rangesFrom(first + block.count, block.box, ranges);
            count += law.mutual(blockPoints, block.count, blockSums, sources, ranges.range.data(), ranges.count, limits,
                                sums);
            result.pairs += 2 * count.pairs;
            if (others_.size() > 0) {
                others_.rangesAround(block.box, ranges);
                const PairCount single =
                    law.single(blockPoints, block.count, blockSums, others, ranges.range.data(), ranges.count, limits);
                result.pairs += single.pairs;
                count += single;
            }
            if (count.coincident) {
                refuseCoincidence(points, block);
            }
            first += block.count;
        }
    }

    const double coulombConstant = 1.0 / (4.0 * pi * permittivity_);
    result.resize(targets);
    for (Index place = 0; place < targets; ++place) {
        const Index row = targets_.order()[place];
        result.field(row, 0) = coulombConstant * fieldX_[place];
        result.field(row, 1) = coulombConstant * fieldY_[place];
        result.field(row, 2) = coulombConstant * fieldZ_[place];
        result.potential[row] = coulombConstant * sumOfPotential_[place];
    }
}

void NearField::refuseCoincidence(const ChargedPoints& points, const TargetBlock& block) const
{
    for (Index place = block.first; place < block.first + block.count; ++place) {
        const Index target = targets_.order()[place];
        refuseSharedPosition(points.position, target, points.position, target);
    }
}

void NearField::coulomb(const ChargedPoints& points, PairSumResult& result)
{
    sort(points, false, pointsPerReach);
    sumAtTargets(points, kernels_.coulomb, limits(), result);
}

void NearField::coulombWithoutDoubleCount(const ChargedPoints& points, PairSumResult& result)
{
    sort(points, true, pointsPerReach);
    sumAtTargets(points, kernels_.withoutDoubleCount, limits(), result);
}

void NearField::screened(const ChargedPoints& points, const ChargeCloud& cloud, PairSumResult& result,
                         NearPrecision precision)
{
    if (cloud.radius() != cutoff_) {
        std::ostringstream message;
        message << "the cloud radius must be the near cutoff, " << cutoff_ << " m, found " << cloud.radius() << " m";
        throw std::invalid_argument(message.str());
    }
    if (precision == NearPrecision::singlePrecision) {
        screenedInSingle(points, cloud, result);
        return;
    }
    const ChargeCloud::Coefficients& coefficients = cloud.coefficients();
    PairLimits ofCloud = limits();
    ofCloud.inverseSquaredRadius = coefficients.inverseSquaredRadius;
    std::copy(coefficients.potential.begin(), coefficients.potential.end(), ofCloud.cloudPotential);
    std::copy(coefficients.field.begin(), coefficients.field.end(), ofCloud.cloudField);
    sort(points, false, pointsPerReach);
    sumAtTargets(points, kernels_.screened[cloud.exponent() - 1], ofCloud, result);
}

}  // namespace him
