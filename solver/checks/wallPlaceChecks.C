// SPDX-License-Identifier: GPL-3.0-or-later
// Whether walls of the DEM scene stand where the meshes of field and gas have theirs.
#include "checks/caseChecks.H"

#include "foamPoissonMesh/conversions.H"
#include "insulatingWalls/wallCharges.H"
#include "settings/checkedDictionary.H"

#include "dem_coupling/exchange/wall_offsets.hpp"

#include "wallPolyPatch.H"

#include <algorithm>
#include <cmath>
#include <limits>

namespace him {

namespace {

/// The faces of a patch on this rank, added to `faces`; their normals point out of the mesh.
void addFaces(const Foam::polyPatch& patch, std::vector<WallFacePolygon>& faces)
{
    for (const Foam::face& face : patch) {
        WallFacePolygon polygon;
        for (const Foam::label point : face) {
            polygon.corners.push_back(toEigen(patch.points()[point]));
        }
        faces.push_back(polygon);
    }
}

/// How far a DEM wall may lie off these faces [m]: what the case says, or a tenth of the edge of the mean face. Collective.
double allowedOffset(const caseSettings& settings, const std::vector<const Foam::polyPatch*>& patches)
{
    if (settings.wallDistance > 0) {
        return settings.wallDistance;
    }
    Foam::scalar area = 0;
    Foam::label faces = 0;
    for (const Foam::polyPatch* patch : patches) {
        area += Foam::sum(Foam::mag(patch->faceAreas()));
        faces += patch->size();
    }
    Foam::reduce(area, Foam::sumOp<Foam::scalar>());
    Foam::reduce(faces, Foam::sumOp<Foam::label>());
    return faces > 0 ? 0.1 * std::sqrt(area / faces) : 0;
}

/// Distance of the first point of a mesh wall that lies off the faces by more than `allowed` [m]; 0 when none does, infinity
/// when all of it lies outside the box of the mesh. Collective.
double offsetOfFacets(const std::vector<Vector3>& points, const std::vector<WallFacePolygon>& mine, const Box& mesh,
                      double allowed, MPI_Comm communicator)
{
    const WallFaces faces(mine, allowed, communicator);
    const std::vector<Vector3> inside = pointsOfFacets(points, mesh.grownBy(allowed));
    for (const Vector3& point : inside) {
        if (faces.find(point, WallFaces::anyWall).face < 0) {
            return faces.distanceTo(point, WallFaces::anyWall);
        }
    }
    return inside.empty() ? std::numeric_limits<double>::infinity() : 0;
}

/// "by 0.02 m", or "altogether" where nothing is near.
std::string shownOffset(double offset)
{
    return std::isfinite(offset) ? "by " + shown(offset) + " m" : "altogether (no face looks its way)";
}

std::string shownAllowed(const caseSettings& settings, double allowed)
{
    return "more than wallDistance, " + shown(allowed) + " m"
           + (settings.wallDistance > 0 ? "" : " (unless given, a tenth of the edge of the mean face)");
}

}  // namespace

void checkGroundedWalls(const caseSettings& settings, const DemPort& dem, const foamPoissonMesh& mesh,
                        MPI_Comm communicator, Complaints& complaints)
{
    const Foam::polyBoundaryMesh& patches = mesh.mesh().boundaryMesh();
    std::vector<const Foam::polyPatch*> conductors;
    for (const Foam::fvPatchScalarField& potential : mesh.electricPotential().boundaryField()) {
        if (!potential.coupled() && potential.fixesValue()
            && !wallCharges::isInsulating(potential.patch().name(), mesh.matter())) {
            conductors.push_back(&potential.patch().patch());
        }
    }
    for (std::size_t n = 0; n < dem.walls().size(); ++n) {
        const DemWall& wall = dem.walls()[n];
        const auto entry = std::find_if(settings.walls.begin(), settings.walls.end(),
                                        [&](const auto& candidate) { return candidate.first == wall.name; });
        const Foam::label patch = entry == settings.walls.end() ? -1 : patches.findPatchID(entry->second);
        if (patch < 0 || wallCharges::isInsulating(entry->second, mesh.matter())) {
            continue;
        }
        double allowed = 0;
        double offset = std::numeric_limits<double>::infinity();
        std::vector<WallFacePolygon> faces;
        if (wall.primitive) {
            allowed = allowedOffset(settings, {&patches[patch]});
            addFaces(patches[patch], faces);
            const WallOffset found = offsetOf(wall.image, faces, Facing::either, communicator);
            const bool plane = wall.image.shape == ImageWall::Shape::plane;
            offset = !found.seen ? offset : plane ? found.nearest : found.farthest;
        } else {
            allowed = allowedOffset(settings, conductors);
            for (const Foam::polyPatch* conductor : conductors) {
                addFaces(*conductor, faces);
            }
            offset = offsetOfFacets(pointsOfAllRanks(dem.wallPoints(n), communicator), faces, mesh.globalBounds(),
                                    allowed, communicator);
        }
        if (offset > allowed) {
            complaints.add("constant/couplingProperties: walls: " + wall.name,
                           "the DEM wall lies off "
                               + std::string(wall.primitive ? "patch " + entry->second : "the patches with a voltage")
                               + " of the mesh " + shownOffset(offset) + ", " + shownAllowed(settings, allowed)
                               + ", so particles would meet it elsewhere than the field has its conductor. Move one of "
                                 "them, or raise "
                                 "wallDistance.");
        }
    }
}

void checkGasWalls(const caseSettings& settings, const DemPort& dem, const Foam::fvMesh& mesh, MPI_Comm communicator,
                   Complaints& complaints)
{
    std::vector<const Foam::polyPatch*> patches;
    std::vector<WallFacePolygon> faces;
    for (const Foam::polyPatch& patch : mesh.boundaryMesh()) {
        if (Foam::isA<Foam::wallPolyPatch>(patch)) {
            patches.push_back(&patch);
            addFaces(patch, faces);
        }
    }
    const double allowed = allowedOffset(settings, patches);
    const Vector3 middle = toEigen(mesh.bounds().centre());
    for (const DemWall& wall : dem.walls()) {
        if (!wall.primitive) {
            continue;
        }
        ImageWall outward = wall.image;
        const bool plane = wall.image.shape == ImageWall::Shape::plane;
        if (plane && (outward.point - middle).dot(outward.normal) < 0) {
            outward.normal = -outward.normal;
        }
        const WallOffset offset = offsetOf(outward, faces, plane ? Facing::outward : Facing::either, communicator);
        if (offset.seen && offset.nearest > allowed) {
            complaints.add(
                "DEM wall " + wall.name,
                "it lies off the walls at which the gas's mesh ends in the same direction "
                    + shownOffset(offset.nearest) + ", " + shownAllowed(settings, allowed)
                    + ", so particles and gas would meet different walls. Move one of them, or raise wallDistance in "
                      "constant/couplingProperties.");
        }
    }
}

}  // namespace him
