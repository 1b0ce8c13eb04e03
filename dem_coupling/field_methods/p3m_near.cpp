// SPDX-License-Identifier: GPL-3.0-or-later
// The short-range part of p3m: pairs, images, and charges that a wall hides from a part of their surroundings.
#include "dem_coupling/field_methods/p3m.hpp"

#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <stdexcept>

namespace him {

void P3m::sumNear(ParticleField& result)
{
    std::string failure;
    sums_.pairs = 0;
    {
        const PhaseTimer timer(times_, Phase::near);
        // Charges that something hides from a part of their surroundings are summed one by one afterwards.
        hides_.resize(static_cast<std::size_t>(sources_.size()));
        Index rows = sources_.targets;
        for (Index row = 0; row < sources_.size(); ++row) {
            const auto r = static_cast<std::size_t>(row);
            hides_[r] = surroundings_.of(sources_.cell[r]).hides;
            if (!hides_[r]) {
                rows += (row >= sources_.targets) + sources_.firstImage[r + 1] - sources_.firstImage[r];
            }
        }
        points_.targets = sources_.targets;
        points_.position.resize(rows, 3);
        points_.charge.resize(rows);
        points_.position.topRows(sources_.targets) = sources_.position.topRows(sources_.targets);
        Index to = sources_.targets;
        for (Index row = 0; row < sources_.size(); ++row) {
            const auto r = static_cast<std::size_t>(row);
            if (row < sources_.targets) {
                points_.charge[row] = hides_[r] ? 0.0 : sources_.charge[row];
            }
            if (hides_[r]) {
                continue;
            }
            if (row >= sources_.targets) {
                points_.position.row(to) = sources_.position.row(row);
                points_.charge[to++] = sources_.charge[row];
            }
            for (auto n = static_cast<std::size_t>(sources_.firstImage[r]);
                 n < static_cast<std::size_t>(sources_.firstImage[r + 1]); ++n) {
                points_.position.row(to) = sources_.images[n].position.transpose().array();
                points_.charge[to++] = sources_.images[n].sign * sources_.charge[row];
            }
        }
        try {
            near_.screened(points_, cloud_, sums_, settings_.p3m.nearPrecision);
            addHiddenPairs();
            walls_.addNearPanels(sources_, settings_.permittivity, sums_.field, sums_.potential);
        } catch (const std::domain_error& error) {
            failure = error.what();
        }
        if (failure.empty()) {
            atTargets_.leftCols(3) = sums_.field;
            atTargets_.col(3) = sums_.potential;
        }
    }
    if (!failure.empty()) {
        // The charges that share a position are here, whoever owns the particles.
        inCells_.tag = particlesOnMesh_.tags();
        inCells_.position = sources_.position.topRows(sources_.targets);
    }
    result.pairs = sumPairs(sums_.pairs, failure, inCells_, points_.position, communicator_);
}

/// Short-range parts of charges near baffles and re-entrant edges, for the targets that can be walked to from them.
void P3m::addHiddenPairs()
{
    if (std::find(hides_.begin(), hides_.end(), true) == hides_.end()) {
        return;
    }
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    // A target that an image acts on is at most 2 R from its charge.
    const double reach = 2 * radius_;
    targetCells_.build(sources_.position, 0, sources_.targets, reach);
    LinkedCells::Ranges near;
    for (Index row = 0; row < sources_.size(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        if (!hides_[r]) {
            continue;
        }
        const Surroundings& around = surroundings_.of(sources_.cell[r]);
        const auto add = [&](Index target, const Vector3& position, double charge) {
            const Vector3 d = sources_.position.row(target).matrix().transpose() - position;
            const double distance = d.norm();
            if (distance >= radius_ || distance == 0) {
                return;
            }
            const Vector3 field = coulombConstant * charge * cloud_.shortRangeFieldCoefficient(distance) * d;
            sums_.field.row(target) += field.transpose().array();
            sums_.potential[target] += coulombConstant * charge * cloud_.shortRangePotential(distance);
            ++sums_.pairs;
        };
        const auto addAll = [&](Index target) {
            if (!around.reaches(sources_.cell[static_cast<std::size_t>(target)])) {
                return;
            }
            if (target != row) {
                add(target, sources_.position.row(row).matrix().transpose(), sources_.charge[row]);
            }
            for (auto n = static_cast<std::size_t>(sources_.firstImage[r]);
                 n < static_cast<std::size_t>(sources_.firstImage[r + 1]); ++n) {
                add(target, sources_.images[n].position, sources_.images[n].sign * sources_.charge[row]);
            }
        };
        Box place;
        place.extend(Vector3(sources_.position.row(row).matrix().transpose()));
        targetCells_.rangesAround(place, near);
        for (int range = 0; range < near.count; ++range) {
            const RowRange& places = near.range[static_cast<std::size_t>(range)];
            for (auto at = places.begin; at < places.end; ++at) {
                addAll(targetCells_.order()[static_cast<std::size_t>(at)]);
            }
        }
    }
}

}  // namespace him
