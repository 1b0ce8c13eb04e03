// SPDX-License-Identifier: GPL-3.0-or-later
// The field of p3m at wall contact points, for `wallField atContactPoint`.
#include "dem_coupling/field_methods/p3m.hpp"

#include "dem_coupling/field_methods/contact_points.hpp"
#include "electrostatics/constants.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace him {

void P3m::preparePoints()
{
    std::ostringstream reason;
    if (fineCells_) {
        reason << "cells are smaller than particles (" << cellSize_
               << " m), and a particle's own cloud is not resolved finely enough to be taken out of the field at its "
                  "surface";
    }
    double kept = walls_.none() ? 0 : 1;
    MPI_Allreduce(MPI_IN_PLACE, &kept, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    if (kept > 0) {
        reason << (reason.str().empty() ? "" : "; ") << "walls inside the mesh keep charge";
    }
    if (!reason.str().empty()) {
        throw std::runtime_error("wallField atContactPoint: p3m does not have it here: " + reason.str()
                                 + ". Use centre (S, the default), larger cells, or pairwiseSum");
    }
    targetOfTag_.clear();
    for (Index target = 0; target < sources_.targets; ++target) {
        targetOfTag_[particlesOnMesh_.tags()[static_cast<std::size_t>(target)]] = target;
    }
    // A charge whose image reaches a point is at most 2 R from it.
    pointCells_.build(sources_.position, 0, sources_.targets, 2 * radius_);
}

Vector3 P3m::shortest(Vector3 way) const
{
    for (int axis = 0; axis < 3; ++axis) {
        if (period_[axis] > 0) {
            way[axis] -= std::round(way[axis] / period_[axis]) * period_[axis];
        }
    }
    return way;
}

/// Short-range field [V/m] at a point of one row's charge and its images.
Vector3 P3m::shortRangeAt(const Vector3& point, Index row) const
{
    const auto field = [&](const Vector3& place) -> Vector3 {
        const Vector3 r = point - place;
        const double distance = r.norm();
        return distance > 0 && distance < radius_ ? Vector3(cloud_.shortRangeFieldCoefficient(distance) * r)
                                                  : Vector3(Vector3::Zero());
    };
    const auto at = static_cast<std::size_t>(row);
    Vector3 sum = field(sources_.position.row(row).matrix().transpose());
    for (auto n = static_cast<std::size_t>(sources_.firstImage[at]);
         n < static_cast<std::size_t>(sources_.firstImage[at + 1]); ++n) {
        sum += sources_.images[n].sign * field(sources_.images[n].position);
    }
    return sources_.charge[row] / (4.0 * pi * settings_.permittivity) * sum;
}

/// The mesh field at a point on a target's surface, from the polynomial of the target's cell, less that of its own cloud and of
/// its images' clouds [V/m].
Vector3 P3m::meshFieldOfOthers(const Vector3& point, Index target)
{
    LocalPolynomial polynomial;
    gather_.fit(sources_.cell[static_cast<std::size_t>(target)], cellPotential_, boundaryValue_, polynomial);
    double value = 0;
    Vector3 gradient;
    polynomial.evaluate(point, value, gradient);
    const auto cloudField = [&](const Vector3& place) -> Vector3 {
        const Vector3 r = point - place;
        return cloud_.fieldCoefficient(r.norm()) * r;
    };
    const auto at = static_cast<std::size_t>(target);
    Vector3 own = cloudField(sources_.position.row(target).matrix().transpose());
    for (auto n = static_cast<std::size_t>(sources_.firstImage[at]);
         n < static_cast<std::size_t>(sources_.firstImage[at + 1]); ++n) {
        own += sources_.images[n].sign * cloudField(sources_.images[n].position);
    }
    return -gradient - sources_.charge[target] / (4.0 * pi * settings_.permittivity) * own;
}

void P3m::fieldOfOthers(const DemParticles&, const Points& points, const std::vector<int>& leftOut, Points& field)
{
    ContactPoints all(points, leftOut, communicator_);
    LinkedCells::Ranges near;
    for (Index n = 0; n < all.size(); ++n) {
        const Vector3 point = all.place(n);
        const auto own = targetOfTag_.find(all.leftOut(n));
        const Index target = own == targetOfTag_.end() ? -1 : own->second;
        if (target >= 0) {
            const Vector3 centre = sources_.position.row(target).matrix().transpose();
            all.add(n, meshFieldOfOthers(centre + shortest(point - centre), target));
        }
        // Every rank adds the charges in its cells, each from where it stands and from its periodic copies.
        for (int copy = 0; copy < 27; ++copy) {
            const Vector3 steps(copy % 3 - 1, copy / 3 % 3 - 1, copy / 9 - 1);
            if ((steps.cwiseAbs().array() > 0 && period_.array() == 0).any()) {
                continue;
            }
            const Vector3 seen = point + steps.cwiseProduct(period_);
            Box place;
            place.extend(seen);
            pointCells_.rangesAround(place, near);
            for (int range = 0; range < near.count; ++range) {
                const RowRange& rows = near.range[static_cast<std::size_t>(range)];
                for (auto at = rows.begin; at < rows.end; ++at) {
                    const Index row = pointCells_.order()[static_cast<std::size_t>(at)];
                    if (row != target) {
                        all.add(n, shortRangeAt(seen, row));
                    }
                }
            }
        }
    }
    all.sum(field);
    field.rowwise() += settings_.externalField.transpose().array();
}

}  // namespace him
