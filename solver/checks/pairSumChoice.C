// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"
#include "settings/checkedDictionary.H"

#include "dem_coupling/accuracy_choice.hpp"

#include <cmath>

namespace him {

namespace {

/// Particles of all ranks. Collective.
Index countOf(const DemPort& dem, MPI_Comm communicator)
{
    DemParticles particles;
    dem.particles(particles);
    std::int64_t count = particles.size();
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, communicator);
    return count;
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

void choosePairSum(caseSettings& settings, const DemPort& dem, const foamPoissonMesh* mesh, MPI_Comm communicator,
                   Complaints& complaints)
{
    FieldSettings& field = settings.field;
    if (!settings.methodByAccuracy) {
        return;
    }
    if (!mesh) {
        requireAccuracyWithoutMesh(field, complaints);
        return;
    }
    const Index particles = countOf(dem, communicator);
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
