// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/him_cell.hpp"

#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace him {

namespace {

/// Share of a length that is round-off: cells nearer than this share of their size touch.
constexpr double roundOff = 1e-9;

/// Largest diagonal of a cell's bounding box [m], all ranks.
double largestDiagonal(const PoissonMesh& mesh, MPI_Comm communicator)
{
    double largest = 0;
    for (const Box& box : mesh.cellBoxes()) {
        largest = std::max(largest, box.size().norm());
    }
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
    return largest;
}

double squaredDistance(const Box& a, const Box& b)
{
    return (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0).squaredNorm();
}

}  // namespace

HimCell::HimCell(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox,
                 const std::array<bool, 3>& periodic, MPI_Comm communicator, PhaseTimes& times)
    : settings_(settings),
      mesh_(mesh),
      communicator_(communicator),
      times_(times),
      cells_(mesh, settings.himCell.deltaMin + 2 * largestDiagonal(mesh, communicator), demBox, periodic, communicator),
      near_(settings.permittivity)
{
    findInteractingCells(mesh);
}

void HimCell::findInteractingCells(const PoissonMesh& mesh)
{
    // Corners of all cells, the copies included, as offsets from the centre, which is known of copies.
    const std::vector<Box> own = mesh.cellBoxes();
    const LocalMesh& local = cells_.mesh();
    std::vector<Box> boxes(static_cast<std::size_t>(local.cells()));
    Scalars values;
    for (int axis = 0; axis < 3; ++axis) {
        for (const auto corner : {&Box::lower, &Box::upper}) {
            values.resize(local.ownCells);
            for (Index cell = 0; cell < local.ownCells; ++cell) {
                values[cell] = (own[static_cast<std::size_t>(cell)].*corner)[axis] - local.centre(cell, axis);
            }
            cells_.halo().forwardCells(values);
            for (Index cell = 0; cell < local.cells(); ++cell) {
                (boxes[static_cast<std::size_t>(cell)].*corner)[axis] = local.centre(cell, axis) + values[cell];
            }
        }
    }
    const double deltaMin = settings_.himCell.deltaMin;
    cells_.findNear([&](const LocalMesh&, Index a, Index b) {
        const Box& boxA = boxes[static_cast<std::size_t>(a)];
        const Box& boxB = boxes[static_cast<std::size_t>(b)];
        const double touching = roundOff * boxA.size().cwiseMax(boxB.size()).norm();
        const double below = std::max(deltaMin * (1 - roundOff), touching);
        return squaredDistance(boxA, boxB) < below * below;
    });
}

void HimCell::compute(const DemParticles& particles, ParticleField& result)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        cells_.locate(particles);
        findOutside(cells_.locator(), particles, communicator_, result);
        if (result.excludedCount > 0 && settings_.outsideMesh == OutsideMesh::error) {
            refuseOutside("himCell", cells_.locator(), particles, result.excludedCount, communicator_);
        }
        cells_.distribute(particles);
        cells_.charges().sumCells(cellCharge_);
    }
    {
        const PhaseTimer timer(times_, Phase::poisson);
        ownCharge_ = cellCharge_.head(cells_.mesh().ownCells);
        mesh_.solve(ownCharge_);
    }
    std::string failure;
    sums_.pairs = 0;
    try {
        const PhaseTimer timer(times_, Phase::near);
        near_.coulomb(cells_.charges(), cells_.near(), sums_);
        addMeshField();
    } catch (const std::domain_error& error) {
        failure = error.what();
    }
    result.pairs = sumPairs(sums_.pairs, failure, failure.empty() ? particles : cells_.targetsForMessages(),
                            cells_.charges().position, communicator_);
    const PhaseTimer timer(times_, Phase::exchange);
    atTargets_ = sums_.field;
    result.field.resize(particles.size(), 3);
    cells_.bringBack(
        atTargets_, [&](Index row, const double* values) { result.field.row(row) << values[0], values[1], values[2]; });
    result.potential.resize(0);
    result.ownResponse.resize(0, 3);
    result.energy = std::numeric_limits<double>::quiet_NaN();
    addExternalField(settings_.externalField, result);
}

/// Mesh field and correction, one vector for all charges of a cell.
void HimCell::addMeshField()
{
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    const LocalMesh& mesh = cells_.mesh();
    for (Index cell = 0; cell < mesh.ownCells; ++cell) {
        const RowRange rows = cells_.charges().rowsOf(cell);
        if (rows.begin == rows.end) {
            continue;
        }
        Vector3 doubleCount = Vector3::Zero();
        for (const std::int32_t other : cells_.near()[cell]) {
            if (cellCharge_[other] != 0) {
                const Vector3 r = mesh.centreOf(cell) - mesh.centreOf(other);
                const double squared = r.squaredNorm();
                doubleCount += cellCharge_[other] / (squared * std::sqrt(squared)) * r;
            }
        }
        const Vector3 field = mesh_.electricField(cell) - coulombConstant * doubleCount;
        sums_.field.middleRows(rows.begin, rows.end - rows.begin).rowwise() += field.transpose().array();
    }
}

}  // namespace him
