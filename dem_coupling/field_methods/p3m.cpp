// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/p3m.hpp"

#include "dem_coupling/field_methods/conducting_planes.hpp"
#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace him {

namespace {

/// Below this many cells per cloud radius the parabolic cloud (k = 1) is the more accurate one (field errors measured on
/// uniform meshes), above it the smoother one.
constexpr double parabolicBelow = 2.3;

constexpr Index valuesPerTarget = 7;

/// Largest of a value over the cells whose centres lie in the DEM box; over all cells where none does. Collective.
double largestInBox(const MeshArrays& mesh, const Scalars& values, const Box& box, MPI_Comm communicator)
{
    double largest[2] = {0, 0};
    for (Index cell = 0; cell < mesh.cells(); ++cell) {
        largest[1] = std::max(largest[1], values[cell]);
        if (box.contains(mesh.centre.row(cell).matrix().transpose())) {
            largest[0] = std::max(largest[0], values[cell]);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPI_DOUBLE, MPI_MAX, communicator);
    return largest[0] > 0 ? largest[0] : largest[1];
}

double radiusFrom(const P3mSettings& settings, double cellSize)
{
    return settings.cloudRadius > 0 ? settings.cloudRadius : settings.cloudCells * cellSize;
}

int exponentFrom(const P3mSettings& settings, double radius, double cellSize)
{
    return settings.cloudExponent > 0 ? settings.cloudExponent : (radius < parabolicBelow * cellSize ? 1 : 2);
}

}  // namespace

P3m::P3m(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox, const std::array<bool, 3>& periodic,
         MPI_Comm communicator, PhaseTimes& times)
    : settings_(settings),
      mesh_(mesh),
      communicator_(communicator),
      times_(times),
      cellSize_(cellSize(mesh.arrays(), demBox, communicator)),
      reachOfCells_(largestInBox(mesh.arrays(), mesh.arrays().radius, demBox, communicator)),
      radius_(radiusFrom(settings.p3m, cellSize_)),
      exponent_(exponentFrom(settings.p3m, radius_, cellSize_)),
      locator_(mesh, communicator, demBox, periodic),
      halo_(mesh.arrays(), 2 * radius_ + 3 * reachOfCells_,
            PolynomialGather::layers(static_cast<int>(settings.p3m.gather)), communicator),
      surroundings_(halo_.mesh(), radius_),
      deposit_(halo_.mesh(), surroundings_, radius_, exponent_),
      gather_(halo_.mesh(), surroundings_, static_cast<int>(settings.p3m.gather)),
      walls_(mesh, halo_, surroundings_, radius_),
      near_(radius_, settings.permittivity),
      cloud_(radius_, exponent_),
      planes_(conductingPlanes(mesh.arrays(), communicator))
{
    const MeshArrays& arrays = mesh.arrays();
    int special[2] = {0, 0};
    for (Index face = 0; face < arrays.boundary.size(); ++face) {
        special[0] = special[0] || !surroundings_.mirrorsExactly(face);
        special[1] = special[1] || arrays.boundary.value[face] != 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, special, 2, MPI_INT, MPI_MAX, communicator);
    faceValues_ = special[0] != 0;
    matched_ = !faceValues_ && special[1] == 0 && mesh.useMatchedOperator();
    correct_ = settings.p3m.deferredCorrection && !matched_;
}

double P3m::cellSize(const MeshArrays& mesh, const Box& demBox, MPI_Comm communicator)
{
    return largestInBox(mesh, mesh.volume.pow(1.0 / 3.0), demBox, communicator);
}

double P3m::partnerCutoff() const
{
    return std::numeric_limits<double>::infinity();
}

void P3m::compute(const DemParticles& particles, ParticleField& result)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        locator_.locate(particles.position);
        findOutside(locator_, particles, communicator_, result);
        if (result.excludedCount > 0 && settings_.outsideMesh == OutsideMesh::error) {
            refuseOutside("p3m", locator_, particles, result.excludedCount, communicator_);
        }
        particlesOnMesh_.distribute(locator_, particles, halo_, radius_ + reachOfCells_, sources_);
        if (!walls_.none()) {
            walls_.update(halo_.exchange());
            walls_.appendTo(sources_);
        }
    }
    atTargets_.setZero(sources_.targets, valuesPerTarget);
    depositAndSolve();
    sumNear(result);
    gatherAtTargets();
    {
        const PhaseTimer timer(times_, Phase::exchange);
        atRows_.resize(particles.size(), valuesPerTarget);
        particlesOnMesh_.bringBack(atTargets_, atRows_, halo_.exchange());
    }
    result.field = atRows_.leftCols(3);
    result.potential = atRows_.col(3);
    result.ownResponse.resize(0, 3);
    if (settings_.ownResponse && planes_.empty()) {
        result.ownResponse = atRows_.rightCols(3);
    } else if (settings_.ownResponse) {
        const PhaseTimer timer(times_, Phase::near);
        planes_.ownField(particles, settings_.permittivity, std::numeric_limits<double>::infinity(),
                         result.ownResponse);
    }
    addExternalField(settings_.externalField, result);
    addExternalPotential(settings_.externalField, particles, result);
}

void P3m::depositAndSolve()
{
    {
        const PhaseTimer timer(times_, Phase::deposit);
        sources_.makeImages(surroundings_, radius_);
        deposit_.deposit(sources_, cellCharge_);
        setBoundaryValues();
    }
    const PhaseTimer timer(times_, Phase::poisson);
    const LocalMesh& mesh = halo_.mesh();
    const auto takePotential = [&] {
        cellPotential_.resize(mesh.cells());
        for (Index cell = 0; cell < mesh.ownCells; ++cell) {
            cellPotential_[cell] = mesh_.potential(cell);
        }
        halo_.forwardCells(cellPotential_);
    };
    // Several methods may share the mesh, so each says what it needs.
    if (matched_) {
        mesh_.useMatchedOperator();
    } else {
        mesh_.useFiniteVolumeOperator();
    }
    mesh_.solve(cellCharge_, boundaryValue_);
    halo_.forwardFaces(boundaryValue_);
    takePotential();
    if (correct_) {
        // What the second-order solve leaves of eps laplacian(V) + rho = 0 at the cell centres, as charge.
        Scalars residual(mesh.ownCells);
        for (Index cell = 0; cell < mesh.ownCells; ++cell) {
            residual[cell] =
                cellCharge_[cell]
                + settings_.permittivity * mesh.volume[cell] * gather_.laplacian(cell, cellPotential_, boundaryValue_);
        }
        mesh_.correct(residual);
        takePotential();
    }
}

/// The mesh part of the potential at boundary faces: the case's own value less the short-range parts of all charges and
/// images in reach; on insulated faces the outward gradient that cancels theirs.
void P3m::setBoundaryValues()
{
    const BoundaryFaces& faces = mesh_.arrays().boundary;
    boundaryValue_ = faces.value;
    if (!faceValues_) {
        return;
    }
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    const auto add = [&](std::int32_t face, const Vector3& position, double charge) {
        const Vector3 r = faces.centre.row(face).matrix().transpose() - position;
        const double distance = r.norm();
        if (distance >= radius_ || distance == 0) {
            return;
        }
        if (faces.condition[static_cast<std::size_t>(face)] == FaceCondition::conductor) {
            boundaryValue_[face] -= coulombConstant * charge * cloud_.shortRangePotential(distance);
        } else {
            const Vector3 normal = faces.normal.row(face).matrix().transpose();
            boundaryValue_[face] +=
                coulombConstant * charge * cloud_.shortRangeFieldCoefficient(distance) * r.dot(normal);
        }
    };
    for (Index row = 0; row < sources_.size(); ++row) {
        const Surroundings& around = surroundings_.of(sources_.cell[static_cast<std::size_t>(row)]);
        for (const std::int32_t face : around.unmirrored) {
            add(face, sources_.position.row(row).matrix().transpose(), sources_.charge[row]);
            for (auto n = static_cast<std::size_t>(sources_.firstImage[static_cast<std::size_t>(row)]);
                 n < static_cast<std::size_t>(sources_.firstImage[static_cast<std::size_t>(row) + 1]); ++n) {
                add(face, sources_.images[n].position, sources_.images[n].sign * sources_.charge[row]);
            }
        }
    }
}

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

void P3m::gatherAtTargets()
{
    const PhaseTimer timer(times_, Phase::gather);
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    const double ownPotential = coulombConstant * cloud_.potential(0);
    const bool ownImages = settings_.ownResponse && planes_.empty();
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
        if (settings_.p3m.selfTerm) {
            atTargets_.row(target).head(3) += ownCloudGradient(target).transpose().array();
        }
        if (ownImages) {
            addOwnImages(target);
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

}  // namespace him
