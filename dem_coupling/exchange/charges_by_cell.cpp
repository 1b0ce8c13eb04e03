// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/charges_by_cell.hpp"

#include "electrostatics/linked_cells.hpp"

#include <algorithm>
#include <numeric>

namespace him {

namespace {

double largestRadius(const MeshArrays& mesh, MPI_Comm communicator)
{
    double radius = mesh.cells() > 0 ? mesh.radius.maxCoeff() : 0;
    MPI_Allreduce(MPI_IN_PLACE, &radius, 1, MPI_DOUBLE, MPI_MAX, communicator);
    return radius;
}

}  // namespace

ChargesByCell::ChargesByCell(const PoissonMesh& mesh, double reach, const Box& demBox, const std::array<bool, 3>& periodic,
                             MPI_Comm communicator)
    : reach_(reach),
      cellRadius_(largestRadius(mesh.arrays(), communicator)),
      locator_(mesh, communicator, demBox, periodic),
      halo_(mesh.arrays(), reach, 1, communicator)
{
}

void ChargesByCell::findNear(const Near& near)
{
    const LocalMesh& mesh = halo_.mesh();
    LinkedCells centres;
    centres.build(mesh.centre, 0, mesh.cells(), reach_);
    near_ = IndexLists();
    LinkedCells::Ranges ranges;
    for (Index cell = 0; cell < mesh.ownCells; ++cell) {
        Box place;
        place.extend(mesh.centreOf(cell));
        centres.rangesAround(place, ranges);
        const auto begin = near_.entries.size();
        for (int n = 0; n < ranges.count; ++n) {
            const RowRange& places = ranges.range[static_cast<std::size_t>(n)];
            for (auto k = places.begin; k < places.end; ++k) {
                const std::int32_t other = centres.order()[static_cast<std::size_t>(k)];
                if (other != cell && near(mesh, cell, other)) {
                    near_.entries.push_back(other);
                }
            }
        }
        std::sort(near_.entries.begin() + static_cast<std::ptrdiff_t>(begin), near_.entries.end());
        near_.closeRow();
    }
}

void ChargesByCell::distribute(const DemParticles& particles)
{
    // A charge of a near cell lies at most this far from the box around the own centres.
    particlesOnMesh_.distribute(locator_, particles, halo_, reach_ + cellRadius_, sources_);
    const LocalMesh& mesh = halo_.mesh();
    charges_.ownCells = mesh.ownCells;
    charges_.firstRow.assign(static_cast<std::size_t>(mesh.cells()) + 1, 0);
    for (const std::int32_t cell : sources_.cell) {
        ++charges_.firstRow[static_cast<std::size_t>(cell) + 1];
    }
    std::partial_sum(charges_.firstRow.begin(), charges_.firstRow.end(), charges_.firstRow.begin());
    next_.assign(charges_.firstRow.begin(), charges_.firstRow.end() - 1);
    charges_.position.resize(sources_.size(), 3);
    charges_.charge.resize(sources_.size());
    for (Index row = 0; row < sources_.size(); ++row) {
        const Index to = next_[static_cast<std::size_t>(sources_.cell[static_cast<std::size_t>(row)])]++;
        charges_.position.row(to) = sources_.position.row(row);
        charges_.charge[to] = sources_.charge[row];
    }
}

DemParticles ChargesByCell::targetsForMessages() const
{
    DemParticles targets;
    targets.tag = particlesOnMesh_.tags();
    targets.position = sources_.position.topRows(sources_.targets);
    return targets;
}

}  // namespace him
