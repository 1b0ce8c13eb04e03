// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/p3m.hpp"

#include "dem_coupling/field_methods/conducting_planes.hpp"
#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <limits>

namespace him {

namespace {

/// Below this many cells per cloud radius the parabolic cloud (k = 1) is the more accurate one (field errors measured on
/// uniform meshes), above it the smoother one.
constexpr double parabolicBelow = 2.3;

constexpr Index valuesPerTarget = 7;

/// Lengths that differ by a smaller share are equal.
constexpr double equalSizes = 1e-6;

/// Images of a particle from this many of its diameters on are left out of its own response: each is below 1e-6 of its surface field.
constexpr double farImages = 500.0;

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
      period_(demBox.size().cwiseProduct(Vector3(periodic[0], periodic[1], periodic[2]))),
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
    if (settings_.ownResponse) {
        prepareOwnResponse(particles);  // behind the run's own solve, which must find the mesh as the last step left it
    }
    sumNear(result);
    gatherAtTargets();
    if (wantsPoints_) {
        preparePoints();
    }
    result.ownResponse.resize(0, 3);
    if (settings_.ownResponse) {
        if (!ownTable_ && !planes_.empty()) {
            const PhaseTimer timer(times_, Phase::near);
            planes_.ownField(particles, settings_.permittivity, farImages * largestDiameter_, result.ownResponse);
        } else {
            result.ownResponse.setZero(particles.size(), 3);
        }
    }
    {
        const PhaseTimer timer(times_, Phase::exchange);
        result.field.resize(particles.size(), 3);
        result.potential.resize(particles.size());
        particlesOnMesh_.bringBack(atTargets_, halo_.exchange(), [&](Index row, const double* values) {
            result.field.row(row) << values[0], values[1], values[2];
            result.potential[row] = values[3];
            if (settings_.ownResponse) {
                result.ownResponse.row(row) += Eigen::Map<const Eigen::Array3d>(values + 4).transpose();
            }
        });
    }
    addExternalField(settings_.externalField, result);
    addExternalPotential(settings_.externalField, particles, result);
}

void P3m::prepareOwnResponse(const DemParticles& particles)
{
    largestDiameter_ = particles.size() > 0 ? 2 * particles.radius.maxCoeff() : 0;
    MPI_Allreduce(MPI_IN_PLACE, &largestDiameter_, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    fineCells_ = fineCells_ || largestDiameter_ > cellSize_ * (1 + equalSizes);
    if (!fineCells_) {
        return;
    }
    const PhaseTimer timer(times_, Phase::poisson);
    if (!tableSought_) {
        tableSought_ = true;
        const auto& conditions = mesh_.arrays().boundary.condition;
        int conductor = std::count(conditions.begin(), conditions.end(), FaceCondition::conductor) > 0;
        MPI_Allreduce(MPI_IN_PLACE, &conductor, 1, MPI_INT, MPI_MAX, communicator_);
        const int order = static_cast<int>(settings_.p3m.gather);
        // Without a conductor the field lines of a single charge have nowhere to end.
        if ((conductor || settings_.neutralisingBackground)
            && OwnResponseTable::fits(halo_.mesh(), surroundings_, order, communicator_)) {
            ownTable_ = std::make_unique<OwnResponseTable>(mesh_, halo_, surroundings_, gather_, order, communicator_);
        }
    }
    if (ownTable_) {
        ownTable_->extend(sources_, [this](const Scalars& charge, Scalars& faceValue, Scalars& potential) {
            solveMesh(charge, faceValue, potential);
        });
    }
}

std::string P3m::ownResponseText() const
{
    if (!settings_.ownResponse || ownTable_) {
        return {};
    }
    if (!fineCells_) {
        return "p3m leaves up to 0.5 % of a particle's surface field of it, in cells of a diameter; less in larger "
               "ones";
    }
    return "WARNING: p3m leaves some per cent of a particle's surface field of it, because cells are smaller than "
           "particles and the "
           "mesh is too large for a table. cloudCells 4 in p3mCoeffs leaves about 0.5 %";
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
    solveMesh(cellCharge_, boundaryValue_, cellPotential_);
}

/// The mesh part of the potential in all cells of the local mesh, with its corrections; brings the boundary values of other ranks' faces.
void P3m::solveMesh(const Scalars& cellCharge, Scalars& boundaryValue, Scalars& cellPotential)
{
    const LocalMesh& mesh = halo_.mesh();
    const auto takePotential = [&] {
        cellPotential.resize(mesh.cells());
        for (Index cell = 0; cell < mesh.ownCells; ++cell) {
            cellPotential[cell] = mesh_.potential(cell);
        }
        halo_.forwardCells(cellPotential);
    };
    // Several methods may share the mesh, so each says what it needs.
    if (matched_) {
        mesh_.useMatchedOperator();
    } else {
        mesh_.useFiniteVolumeOperator();
    }
    mesh_.solve(cellCharge, boundaryValue);
    halo_.forwardFaces(boundaryValue);
    takePotential();
    if (correct_) {
        // What the second-order solve leaves of eps laplacian(V) + rho = 0 at the cell centres, as charge.
        Scalars residual(mesh.ownCells);
        for (Index cell = 0; cell < mesh.ownCells; ++cell) {
            residual[cell] =
                cellCharge[cell]
                + settings_.permittivity * mesh.volume[cell] * gather_.laplacian(cell, cellPotential, boundaryValue);
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
    for (Index row = 0; row < sources_.size(); ++row) {
        for (const std::int32_t face : surroundings_.of(sources_.cell[static_cast<std::size_t>(row)]).unmirrored) {
            boundaryValue_[face] += coulombConstant * sources_.wallValue(row, faces, face, cloud_);
        }
    }
}

}  // namespace him
