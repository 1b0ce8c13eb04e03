// SPDX-License-Identifier: GPL-3.0-or-later
// What p3m's targets get from the mesh, and what of it is their own.
#include "dem_coupling/field_methods/p3m.hpp"

#include "electrostatics/constants.hpp"

#include <cmath>

namespace him {

void P3m::gatherAtTargets()
{
    const PhaseTimer timer(times_, Phase::gather);
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    const double ownPotential = coulombConstant * cloud_.potential(0);
    const bool ownImages = settings_.ownResponse && planes_.empty() && !ownTable_;
    // In cells of a particle's size and more the mesh gives too little back to matter.
    const bool ownCloud = settings_.ownResponse && fineCells_ && !ownTable_;
    LocalPolynomial polynomial;
    Index fitted = -1;
    for (Index target = 0; target < sources_.targets; ++target) {
        const Index cell = sources_.cell[static_cast<std::size_t>(target)];
        if (cell != fitted) {
            gather_.fit(cell, cellPotential_, boundaryValue_, polynomial);
            fitted = cell;
        }
        const Vector3 place = sources_.position.row(target).matrix().transpose();
        double value = 0;
        Vector3 gradient;
        polynomial.evaluate(place, value, gradient);
        atTargets_.row(target).head(3) -= gradient.transpose().array();
        atTargets_(target, 3) += value - ownPotential * sources_.charge[target];
        if (settings_.p3m.selfTerm || ownCloud) {
            const Vector3 taken = ownCloudGradient(target);
            if (settings_.p3m.selfTerm) {
                atTargets_.row(target).head(3) += taken.transpose().array();
            } else {
                atTargets_.row(target).tail(3) -= taken.transpose().array();
            }
        }
        if (ownImages) {
            addOwnImages(target);
        } else if (ownTable_ && sources_.charge[target] != 0) {
            atTargets_.row(target).tail(3) = ownFieldFromTable(target).transpose().array();
        }
    }
}

/// What the polynomial makes at a target of the potential of its own cloud and of its images' clouds at the stencil, less
/// the true gradient there, that of the images [V/m].
Vector3 P3m::ownCloudGradient(Index target)
{
    const LocalMesh& mesh = halo_.mesh();
    const auto t = static_cast<std::size_t>(target);
    const Index cell = sources_.cell[t];
    const Vector3 place = sources_.position.row(target).matrix().transpose();
    const double scale = sources_.charge[target] / (4.0 * pi * settings_.permittivity);
    const auto first = static_cast<std::size_t>(sources_.firstImage[t]);
    const auto last = static_cast<std::size_t>(sources_.firstImage[t + 1]);
    const auto potentialAt = [&](const Vector3& x) {
        double sum = cloud_.potential((x - place).norm());
        for (std::size_t n = first; n < last; ++n) {
            sum += sources_.images[n].sign * cloud_.potential((x - sources_.images[n].position).norm());
        }
        return scale * sum;
    };
    const auto fieldAt = [&](const Vector3& x) {
        Vector3 sum = cloud_.fieldCoefficient((x - place).norm()) * (x - place);
        for (std::size_t n = first; n < last; ++n) {
            const Vector3 r = x - sources_.images[n].position;
            sum += sources_.images[n].sign * cloud_.fieldCoefficient(r.norm()) * r;
        }
        return Vector3(scale * sum);
    };
    scratchCells_.resize(mesh.cells());
    scratchFaces_.resize(mesh.boundary.size());
    scratchCells_[cell] = potentialAt(mesh.centreOf(cell));
    for (const auto& point : gather_.stencilCells(cell)) {
        scratchCells_[point.cell] = potentialAt(mesh.centreOf(point.cell));
    }
    for (const std::int32_t face : gather_.stencilFaces(cell)) {
        const Vector3 x = mesh.boundary.centre.row(face).matrix().transpose();
        const bool value = mesh.boundary.condition[static_cast<std::size_t>(face)] != FaceCondition::insulated;
        scratchFaces_[face] =
            value ? potentialAt(x) : -fieldAt(x).dot(mesh.boundary.normal.row(face).matrix().transpose());
    }
    LocalPolynomial polynomial;
    gather_.fit(cell, scratchCells_, scratchFaces_, polynomial);
    double value = 0;
    Vector3 gradient;
    polynomial.evaluate(place, value, gradient);
    return gradient + fieldAt(place);
}

/// Coulomb field of a target's own images: what p3m knows of its own response.
void P3m::addOwnImages(Index target)
{
    const auto t = static_cast<std::size_t>(target);
    for (auto n = static_cast<std::size_t>(sources_.firstImage[t]);
         n < static_cast<std::size_t>(sources_.firstImage[t + 1]); ++n) {
        const Vector3 r = sources_.position.row(target).matrix().transpose() - sources_.images[n].position;
        const double scale = sources_.images[n].sign * sources_.charge[target] / (4.0 * pi * settings_.permittivity);
        atTargets_.row(target).tail(3) += scale * (r / std::pow(r.norm(), 3)).transpose().array();
    }
}

/// All that this method makes of a target's own charge at the target, selfTerm included [V/m].
Vector3 P3m::ownFieldFromTable(Index target)
{
    const auto t = static_cast<std::size_t>(target);
    deposit_.depositOne(sources_, target, ownCharge_);
    Vector3 field = -ownTable_->gradient(sources_, target, ownCharge_, cloud_, settings_.permittivity);
    const double scale = sources_.charge[target] / (4.0 * pi * settings_.permittivity);
    for (auto n = static_cast<std::size_t>(sources_.firstImage[t]);
         n < static_cast<std::size_t>(sources_.firstImage[t + 1]); ++n) {
        const Vector3 r = sources_.position.row(target).matrix().transpose() - sources_.images[n].position;
        field += sources_.images[n].sign * scale * cloud_.shortRangeFieldCoefficient(r.norm()) * r;
    }
    if (settings_.p3m.selfTerm) {
        field += ownCloudGradient(target);
    }
    return field;
}

}  // namespace him
