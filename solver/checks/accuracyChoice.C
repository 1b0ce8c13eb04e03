// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"
#include "settings/checkedDictionary.H"

#include "dem_coupling/accuracy_choice.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Clouds for cells smaller than the particles: the largest that are known where the accuracy is out of reach, of which
/// printScene warns.
void chooseClouds(FieldSettings& field)
{
    const double reachable = std::max(field.accuracy, smallestAccuracy(field.cellsPerDiameter));
    const P3mSettings chosen = chooseForAccuracy(reachable, field.cellsPerDiameter).p3m;
    field.p3m.cloudCells = chosen.cloudCells;
    field.p3m.gather = chosen.gather;
    field.p3m.deferredCorrection = chosen.deferredCorrection;
}

void requireAccuracyWithoutMesh(const FieldSettings& field, Complaints& complaints)
{
    const double expected = expectedError(field);
    if (!(expected <= field.accuracy)) {
        complaints.add("constant/electrostaticProperties: accuracy",
                       "found " + shown(field.accuracy)
                           + ". Without a mesh there is only pairwiseSum with images, and its error here "
                           + (std::isnan(expected) ? "is not known (a curved wall, or a truncated sum)"
                                                   : "is up to " + shown(expected) + " (parallel walls)")
                           + ". Make a mesh in constant/polyMesh, so that p3m can serve, or give fieldMethod.");
    }
}

}  // namespace

void chooseByAccuracy(caseSettings& settings, const DemPort& dem, const foamPoissonMesh* mesh, MPI_Comm communicator,
                      Complaints& complaints)
{
    FieldSettings& field = settings.field;
    if (field.accuracy == 0) {
        return;
    }
    if (!mesh) {
        if (settings.methodByAccuracy) {
            requireAccuracyWithoutMesh(field, complaints);
        }
        return;
    }
    DemParticles own;
    dem.particles(own);
    std::int64_t particles = own.size();
    MPI_Allreduce(MPI_IN_PLACE, &particles, 1, MPI_INT64_T, MPI_SUM, communicator);
    field.cellsPerDiameter = cellsPerDiameter(own, *mesh, dem.box(), communicator);
    if (settings.cloudsByAccuracy) {
        chooseClouds(field);
    }
    if (!settings.methodByAccuracy) {
        return;
    }
    const Index cells = Foam::returnReduce(mesh->mesh().nCells(), Foam::sumOp<Foam::label>());
    // An empty scene will be filled, nobody knows how far.
    if (particles == 0 || field.accuracy < errorBetweenParallelWalls || field.outsideMesh == OutsideMesh::excluded
        || !pairSumIsCheaper(particles, cells)) {
        return;
    }
    if (const auto box = groundedBox(*mesh, dem.periodic(), communicator)) {
        field.method = "pairwiseSum";
        field.pairwiseSum = {};
        field.pairwiseSum.images = true;
        field.pairwiseSum.imageWalls = wallsOf(*box);
    }
}

}  // namespace him
