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

}  // namespace him
