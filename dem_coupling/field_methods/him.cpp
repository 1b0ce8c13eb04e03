// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/him.hpp"

#include "dem_coupling/field_methods/own_cell_field.hpp"
#include "dem_coupling/field_methods/shared_steps.hpp"

#include <limits>
#include <numeric>
#include <stdexcept>

namespace him {

Him::Him(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox, const std::array<bool, 3>& periodic,
         MPI_Comm communicator, PhaseTimes& times)
    : settings_(settings),
      mesh_(mesh),
      communicator_(communicator),
      times_(times),
      locator_(mesh, communicator, demBox, periodic),
      halo_(settings.nearCutoff, demBox, periodic, communicator),
      near_(settings.nearCutoff, settings.permittivity)
{
}

void Him::compute(const DemParticles& particles, ParticleField& result)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        locator_.locate(particles.position);
        findOutside(locator_, particles, communicator_, result);
    }
    if (result.excludedCount > 0 && settings_.outsideMesh == OutsideMesh::error) {
        refuseOutside("him", locator_, particles, result.excludedCount, communicator_);
    }
    if (settings_.him.ownCellResponse != OwnCellResponse::keep) {
        extendOwnCellTable(particles.size());
    }
    addMeshField(particles, result);
    {
        const PhaseTimer timer(times_, Phase::exchange);
        points_.position = particles.position;
        points_.charge = particles.charge;
        locator_.cellCentres(particles.position, points_.cellCentre);
        halo_.extend(points_);
        if (result.excludedCount > 0) {
            halo_.forward(inMesh_);
        }
    }
    std::string failure;
    sums_.pairs = 0;
    try {
        const PhaseTimer timer(times_, Phase::near);
        sumNear(result.excludedCount > 0);
    } catch (const std::domain_error& error) {
        failure = error.what();
    }
    result.pairs = sumPairs(sums_.pairs, failure, particles, points_.position, communicator_);
    result.field += sums_.field;
    result.ownResponse.resize(0, 3);
    if (settings_.him.ownCellResponse == OwnCellResponse::remove) {
        Points own;
        ownCellResponse(particles, own);
        result.field -= own;
    } else if (settings_.him.ownCellResponse == OwnCellResponse::forceOnly && settings_.ownResponse) {
        ownCellResponse(particles, result.ownResponse);
    }
    result.potential.resize(0);
    result.energy = std::numeric_limits<double>::quiet_NaN();
    addExternalField(settings_.externalField, result);
}

std::optional<OwnCellField> Him::ownCellField(const DemParticles& particles)
{
    if (settings_.him.ownCellResponse == OwnCellResponse::remove) {
        return std::nullopt;
    }
    return probeOwnCellField(mesh_, locator_, particles, settings_.permittivity, communicator_);
}

void Him::extendOwnCellTable(Index particles)
{
    const PhaseTimer timer(times_, Phase::poisson);
    ownCellField_.resize(static_cast<std::size_t>(mesh_.cellCount()), Vector3::Zero());
    ownCellKnown_.resize(static_cast<std::size_t>(mesh_.cellCount()), false);
    locator_.deposit(Scalars::Ones(particles), cellCharge_);
    std::vector<Index> fresh;
    for (Index cell = 0; cell < cellCharge_.size(); ++cell) {
        if (cellCharge_[cell] > 0 && !ownCellKnown_[static_cast<std::size_t>(cell)]) {
            fresh.push_back(cell);
        }
    }
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(communicator_, &rank);
    MPI_Comm_size(communicator_, &ranks);
    std::vector<int> counts(static_cast<std::size_t>(ranks));
    const int mine = static_cast<int>(fresh.size());
    MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator_);
    if (std::accumulate(counts.begin(), counts.end(), 0) == 0) {
        return;
    }
    // One coulomb: beside its field that of any electrode vanishes. What is left of it must not be the start of the run's own
    // solve, which would take a share of it for the field of small charges.
    const auto kept = mesh_.keep();
    for (int turn = 0; turn < ranks; ++turn) {
        for (int n = 0; n < counts[static_cast<std::size_t>(turn)]; ++n) {
            cellCharge_.setZero(mesh_.cellCount());
            const bool here = turn == rank;
            const auto cell = here ? static_cast<std::size_t>(fresh[static_cast<std::size_t>(n)]) : 0;
            if (here) {
                cellCharge_[static_cast<Index>(cell)] = 1;
            }
            mesh_.forgetPotential();
            mesh_.solve(cellCharge_);
            if (here) {
                ownCellField_[cell] = mesh_.electricField(static_cast<Index>(cell));
                ownCellKnown_[cell] = true;
            }
        }
    }
    if (kept) {
        mesh_.restore(kept.get());
    }
}

void Him::ownCellResponse(const DemParticles& particles, Points& field)
{
    const PhaseTimer timer(times_, Phase::exchange);
    locator_.gather([this](Index cell) { return ownCellField_[static_cast<std::size_t>(cell)]; }, field);
    field.colwise() *= particles.charge;
}

void Him::addMeshField(const DemParticles& particles, ParticleField& result)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        locator_.deposit(particles.charge, cellCharge_);
    }
    {
        const PhaseTimer timer(times_, Phase::poisson);
        mesh_.solve(cellCharge_);
    }
    const PhaseTimer timer(times_, Phase::exchange);
    locator_.gather([this](Index cell) { return mesh_.electricField(cell); }, result.field);  // R30
    inMesh_.resize(particles.size());
    for (Index row = 0; row < particles.size(); ++row) {
        inMesh_[row] = locator_.inMesh(row) ? 1.0 : 0.0;
    }
}

void Him::sumNear(bool someExcluded)
{
    if (someExcluded) {
        sumNearWithExcluded();
    } else {
        near_.coulombWithoutDoubleCount(points_, sums_);
    }
}

/// The mesh holds nothing of an excluded particle and an excluded particle sees nothing of the mesh, so R31 applies to
/// the pairs that are both inside only; all other pairs keep their Coulomb field. Three sums, each over all pairs; their
/// charges tell which sources act.
void Him::sumNearWithExcluded()
{
    const Scalars charge = points_.charge;
    const Index targets = points_.targets;

    near_.coulomb(points_, sums_);  // excluded targets: everybody
    const std::int64_t pairs = sums_.pairs;

    points_.charge = charge * inMesh_;
    near_.coulombWithoutDoubleCount(points_, partialSums_);  // inside targets: the sources inside
    for (Index row = 0; row < targets; ++row) {
        if (inMesh_[row] == 1.0) {
            sums_.field.row(row) = partialSums_.field.row(row);
        }
    }
    points_.charge = charge * (1 - inMesh_);
    near_.coulomb(points_, partialSums_);  // inside targets: the sources outside
    for (Index row = 0; row < targets; ++row) {
        if (inMesh_[row] == 1.0) {
            sums_.field.row(row) += partialSums_.field.row(row);
        }
    }
    sums_.pairs = pairs;
    points_.charge = charge;
}

}  // namespace him
