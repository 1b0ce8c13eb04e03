// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/near_field.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/require.hpp"

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

// What acts between two points: the kernel for one-sided pairs and the one for pairs of targets.

struct CoulombLaw {
    static constexpr bool cellCentres = false;
    PairSum operator()(const SourceArrays& sources, const LinkedCells::Ranges& ranges, const PairTarget& target,
                       const PairLimits& limits) const
    {
        return sumCoulomb(sources, ranges.range.data(), ranges.count, target, limits);
    }
    PairSum operator()(const SourceArrays& sources, const LinkedCells::Ranges& ranges, const PairTarget& target,
                       const PairLimits& limits, const ReactionArrays& reaction) const
    {
        return sumMutualCoulomb(sources, ranges.range.data(), ranges.count, target, limits, reaction);
    }
};

struct WithoutDoubleCount {
    static constexpr bool cellCentres = true;
    PairSum operator()(const SourceArrays& sources, const LinkedCells::Ranges& ranges, const PairTarget& target,
                       const PairLimits& limits) const
    {
        return sumWithoutDoubleCount(sources, ranges.range.data(), ranges.count, target, limits);
    }
    PairSum operator()(const SourceArrays& sources, const LinkedCells::Ranges& ranges, const PairTarget& target,
                       const PairLimits& limits, const ReactionArrays& reaction) const
    {
        return sumMutualWithoutDoubleCount(sources, ranges.range.data(), ranges.count, target, limits, reaction);
    }
};

struct ScreenedLaw {
    static constexpr bool cellCentres = false;
    const ChargeCloud::Coefficients& cloud;
    PairSum operator()(const SourceArrays& sources, const LinkedCells::Ranges& ranges, const PairTarget& target,
                       const PairLimits& limits) const
    {
        return sumScreened(sources, ranges.range.data(), ranges.count, target, limits, cloud);
    }
    PairSum operator()(const SourceArrays& sources, const LinkedCells::Ranges& ranges, const PairTarget& target,
                       const PairLimits& limits, const ReactionArrays& reaction) const
    {
        return sumMutualScreened(sources, ranges.range.data(), ranges.count, target, limits, cloud, reaction);
    }
};

}  // namespace

NearField::NearField(double cutoff, double permittivity) : cutoff_(cutoff), permittivity_(permittivity)
{
    if (!std::isgreaterequal(cutoff, shortestCutoff) || !std::islessequal(cutoff, largestCoordinate)) {
        rejectArgument("near cutoff [m]", "> 0 (1e-40 to 1e50)", cutoff);
    }
    requirePositive("permittivity", permittivity);
}

void NearField::sort(const ChargedPoints& points, bool withCellCentres)
{
    requireMatching(points, withCellCentres);
    const Index rows = points.position.rows();
    targets_.build(points.position, 0, points.targets, cutoff_);
    others_.build(points.position, points.targets, rows - points.targets, cutoff_);

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

template <class Law> void NearField::sumAtTargets(const ChargedPoints& points, const Law& law, PairSumResult& result)
{
    const Index targets = points.targets;
    const PairLimits limits{cutoff_ * cutoff_, sameCellShare * sameCellShare * cutoff_ * cutoff_};
    const SourceArrays sources{x_.data(), y_.data(), z_.data(), q_.data(), cellX_.data(), cellY_.data(), cellZ_.data()};
    const SourceArrays others = sources.from(targets);
    const ReactionArrays sums{fieldX_.data(), fieldY_.data(), fieldZ_.data(), sumOfPotential_.data()};
    for (Scalars* values : {&fieldX_, &fieldY_, &fieldZ_, &sumOfPotential_}) {
        values->head(targets + sourcePadding).setZero();
    }

    result.pairs = 0;
    LinkedCells::Ranges ranges;
    for (Index place = 0; place < targets; ++place) {
        PairTarget target{{x_[place], y_[place], z_[place]}, Vector3::Zero(), q_[place]};
        if (Law::cellCentres) {
            target.cellCentre = {cellX_[place], cellY_[place], cellZ_[place]};
        }
        // Every pair of targets once, for both; the other sources act on the target only.
        targets_.rangesAfter(place, target.position, ranges);
        const PairSum mutual = law(sources, ranges, target, limits, sums);
        others_.rangesAround(target.position, ranges);
        const PairSum single = law(others, ranges, target, limits);
        if (mutual.coincident || single.coincident) {
            const Index row = targets_.order()[place];
            throwSharedPosition(points.position, row, points.position, row);
        }
        const Vector3 field = mutual.field + single.field;
        fieldX_[place] += field.x();
        fieldY_[place] += field.y();
        fieldZ_[place] += field.z();
        sumOfPotential_[place] += mutual.potential + single.potential;
        result.pairs += 2 * mutual.pairs + single.pairs;
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

void NearField::coulomb(const ChargedPoints& points, PairSumResult& result)
{
    sort(points, false);
    sumAtTargets(points, CoulombLaw(), result);
}

void NearField::coulombWithoutDoubleCount(const ChargedPoints& points, PairSumResult& result)
{
    sort(points, true);
    sumAtTargets(points, WithoutDoubleCount(), result);
}

void NearField::screened(const ChargedPoints& points, const ChargeCloud& cloud, PairSumResult& result)
{
    if (cloud.radius() != cutoff_) {
        std::ostringstream message;
        message << "the cloud radius must be the near cutoff, " << cutoff_ << " m, found " << cloud.radius() << " m";
        throw std::invalid_argument(message.str());
    }
    sort(points, false);
    sumAtTargets(points, ScreenedLaw{cloud.coefficients()}, result);
}

}  // namespace him
