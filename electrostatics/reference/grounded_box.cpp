// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/reference/grounded_box.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/point_checks.hpp"
#include "electrostatics/reference/box_sums.hpp"
#include "electrostatics/require.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

double lengthOf(const Box& box, int axis)
{
    const double length = box.empty() ? 0 : box.size()[axis];
    requirePositive("each side of the box", length);
    return length;
}

BoxAxis axisOf(const Box& box, const BoxSides& sides, std::size_t axis)
{
    return {lengthOf(box, static_cast<int>(axis)), sides.lower[axis], sides.upper[axis]};
}

// Rough costs [ns], measured on one core; only their ratios matter.
constexpr double pairCost = 12;
constexpr double columnCost = 30;           ///< of one column of cells that a target looks into
constexpr double chargeAndModeCost = 0.25;  ///< of one mode of one charge
constexpr double targetAndModeCost = 0.7;   ///< of one mode at one target

}  // namespace

GroundedBox::GroundedBox(const Box& box, double permittivity, const BoxSides& sides)
    : box_(box), permittivity_(permittivity), axes_{axisOf(box, sides, 0), axisOf(box, sides, 1), axisOf(box, sides, 2)}
{
    requirePositive("permittivity", permittivity);
    setTolerance(1e-11);
}

void GroundedBox::setTolerance(double tolerance)
{
    if (!std::isgreaterequal(tolerance, 1e-15) || !std::islessequal(tolerance, 1e-3)) {
        rejectArgument("tolerance", "in 1e-15..1e-3", tolerance);
    }
    reach_ = std::sqrt(-std::log(tolerance));
}

void GroundedBox::setCutoff(double cutoff)
{
    requireNotNegative("cutoff", cutoff);
    cutoff_ = cutoff;
}

double GroundedBox::chosenCutoff(Index charges, Index targets) const
{
    if (cutoff_ > 0) {
        return cutoff_;
    }
    const Vector3 size = box_.size();
    const double density = static_cast<double>(charges) / size.prod();
    const auto t = static_cast<double>(targets);
    const auto n = static_cast<double>(charges);
    double best = 0;
    double lowest = std::numeric_limits<double>::max();
    for (double cutoff = 0.02 * size.maxCoeff(); cutoff < 4 * size.maxCoeff(); cutoff *= 1.1) {
        double modes = 0;
        for (const ModeLayer& layer : modeLayers(axes_, 2 * reach_ * reach_ / cutoff)) {
            modes += static_cast<double>(layer.x * layer.y);
        }
        const double width = std::max(0.25 * cutoff, std::cbrt(2 / density));
        const double sphere = 4.0 / 3.0 * pi * cutoff * cutoff * cutoff;
        const double columns = std::pow(2 * cutoff / width + 1, 2) * (1 + 2 * cutoff / size.minCoeff());
        const double cost = t * (pairCost * density * sphere + columnCost * columns)
                            + modes * (chargeAndModeCost * n + targetAndModeCost * t);
        if (cost < lowest) {
            lowest = cost;
            best = cutoff;
        }
    }
    return best;
}

Points GroundedBox::fromLowerCorner(const char* what, const Points& position) const
{
    Points moved(position.rows(), 3);
    for (Index row = 0; row < position.rows(); ++row) {
        for (int axis = 0; axis < 3; ++axis) {
            requireFinite(what, row, position(row, axis));
        }
        if (!box_.contains(position.row(row).matrix().transpose())) {
            std::ostringstream text;
            text << "the " << what << " of row " << row << ", " << pointText(position.row(row).matrix())
                 << ", is not inside the box from " << pointText(box_.lower) << " to " << pointText(box_.upper);
            throw std::domain_error(text.str());
        }
        moved.row(row) = position.row(row) - box_.lower.transpose().array();
    }
    return moved;
}

void GroundedBox::compute(const Points& position, const Scalars& charge, Points& field, Scalars& potential) const
{
    std::vector<Index> rows(static_cast<std::size_t>(position.rows()));
    std::iota(rows.begin(), rows.end(), Index{0});
    computeAt(position, charge, position, rows, field, potential);
}

void GroundedBox::computeAt(const Points& position, const Scalars& charge, const Points& targets,
                            const std::vector<Index>& ownRow, Points& field, Scalars& potential) const
{
    if (charge.size() != position.rows() || static_cast<Index>(ownRow.size()) != targets.rows()) {
        throw std::invalid_argument(
            "GroundedBox: the lengths of positions and charges, or of targets and own rows, differ");
    }
    for (Index row = 0; row < charge.size(); ++row) {
        requireFinite("charge", row, charge[row]);
    }
    const Points sources = fromLowerCorner("position", position);
    const Points places = fromLowerCorner("target", targets);
    field.setZero(targets.rows(), 3);
    potential.setZero(targets.rows());
    if (sources.rows() == 0 || places.rows() == 0) {
        return;
    }

    const double cutoff = chosenCutoff(sources.rows(), places.rows());
    const double alpha = reach_ / cutoff;
    const BoxSum sum{axes_, sources, charge, places, ownRow};
    addScreenedPairs(sum, EwaldKernel(alpha, cutoff), cutoff, field, potential);
    addModes(sum, alpha, 2 * alpha * reach_, field, potential);
    for (Index target = 0; target < places.rows(); ++target) {
        const Index own = ownRow[static_cast<std::size_t>(target)];
        if (own >= 0) {
            potential[target] -= 2 * alpha / std::sqrt(pi) * charge[own];  // its own Gaussian cloud
        }
    }
    if (!axes_[0].grounded() && !axes_[1].grounded() && !axes_[2].grounded()) {
        // Mean of the screened part; the modes have none.
        potential -= pi * charge.sum() / (alpha * alpha * box_.size().prod());
    }
    const double coulombConstant = 1 / (4 * pi * permittivity_);
    field *= coulombConstant;
    potential *= coulombConstant;
}

}  // namespace him
