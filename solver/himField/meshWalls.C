// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/roundWall.H"
#include "himField/snapshot.H"

#include "foamPoissonMesh/conversions.H"
#include "settings/checkedDictionary.H"

#include <cmath>

namespace him {

namespace {

/// Faces belong to one plane when normals differ by less than this, and distances by this share of the mesh size.
constexpr double sameplane = 1e-5;

/// A mesh with more planes than this is taken as curved.
constexpr std::size_t mostPlanes = 32;

/// Planes whose normals have a larger product than this, though they differ, are facets of a curved wall: the facets turn by less
/// than 60 degrees, and images in each of them are none of the wall. Of curved walls only findRoundWall() knows images.
constexpr double facets = 0.5 + sameplane;

struct plane {
    Foam::vector normal;  ///< unit, out of the mesh
    Foam::point point;
    Foam::word patch;
};

bool same(const plane& a, const plane& b, double size)
{
    return Foam::mag(a.normal - b.normal) < sameplane && std::abs((a.point - b.point) & a.normal) < sameplane * size;
}

void addNew(std::vector<plane>& planes, const plane& candidate, double size)
{
    for (const plane& known : planes) {
        if (same(known, candidate, size)) {
            return;
        }
    }
    if (planes.size() <= mostPlanes) {
        planes.push_back(candidate);
    }
}

/// Planes of this rank's conducting faces; what stands against mirroring goes to `refusal`.
std::vector<plane> ownPlanes(const foamPoissonMesh& poisson, double size, std::string& refusal)
{
    std::vector<plane> planes;
    for (const Foam::fvPatchScalarField& potential : poisson.electricPotential().boundaryField()) {
        const Foam::fvPatch& patch = potential.patch();
        if (potential.coupled() || patch.size() == 0) {
            continue;
        }
        if (!potential.fixesValue()) {
            refusal = "patch " + patch.name() + " does not fix the voltage";
        } else if (Foam::max(Foam::mag(potential)()) > 0) {
            refusal = "patch " + patch.name() + " is at a voltage";
        }
        const Foam::vectorField normal(patch.nf());
        forAll(normal, face)
        {
            addNew(planes, {normal[face], patch.Cf()[face], patch.name()}, size);
        }
    }
    return planes;
}

/// Every rank's planes, without repetitions. Collective.
std::vector<plane> allPlanes(const std::vector<plane>& own, double size)
{
    Foam::List<Foam::List<Foam::vector>> vectors(Foam::Pstream::nProcs());
    Foam::List<Foam::wordList> names(Foam::Pstream::nProcs());
    for (const plane& p : own) {
        vectors[Foam::Pstream::myProcNo()].append(p.normal);
        vectors[Foam::Pstream::myProcNo()].append(p.point);
        names[Foam::Pstream::myProcNo()].append(p.patch);
    }
    Foam::Pstream::gatherList(vectors);
    Foam::Pstream::scatterList(vectors);
    Foam::Pstream::gatherList(names);
    Foam::Pstream::scatterList(names);
    std::vector<plane> planes;
    forAll(names, rank)
    {
        forAll(names[rank], n)
        {
            addNew(planes, {vectors[rank][2 * n], vectors[rank][2 * n + 1], names[rank][n]}, size);
        }
    }
    return planes;
}

bool curved(const std::vector<plane>& planes)
{
    for (const plane& a : planes) {
        for (const plane& b : planes) {
            if ((a.normal & b.normal) > facets && Foam::mag(a.normal - b.normal) > sameplane) {
                return true;
            }
        }
    }
    return planes.size() > mostPlanes;
}

/// Whether no point of the mesh lies behind a plane. Collective.
bool convex(const foamPoissonMesh& poisson, const std::vector<plane>& planes, double size)
{
    bool inside = true;
    for (const plane& p : planes) {
        for (const Foam::point& point : poisson.mesh().points()) {
            inside = inside && ((point - p.point) & p.normal) < sameplane * size;
        }
    }
    return Foam::returnReduce(inside, Foam::andOp<bool>());
}

}  // namespace

meshWalls findMeshWalls(const foamPoissonMesh& mesh)
{
    const double size = mesh.globalBounds().size().norm();
    meshWalls walls;
    std::string refusal;
    const std::vector<plane> planes = allPlanes(ownPlanes(mesh, size, refusal), size);
    Foam::List<Foam::string> refusals(Foam::Pstream::nProcs());
    refusals[Foam::Pstream::myProcNo()] = refusal;
    Foam::Pstream::gatherList(refusals);
    Foam::Pstream::scatterList(refusals);
    for (const Foam::string& text : refusals) {
        walls.refusal = walls.refusal.empty() ? std::string(text) : walls.refusal;
    }
    if (curved(planes)) {
        const std::vector<ImageWall> round = findRoundWall(mesh);
        if (round.empty()) {
            walls.refusal = "the walls are curved";
        } else if (walls.refusal.empty()) {
            walls.mirrors = round;
        }
        return walls;
    }
    if (!convex(mesh, planes, size)) {
        walls.refusal = "the walls are not convex";
    }
    if (walls.refusal.empty()) {
        for (std::size_t n = 0; n < planes.size(); ++n) {
            ImageWall wall;
            wall.name = planes[n].patch + " " + std::to_string(n);
            wall.point = toEigen(planes[n].point);
            wall.normal = toEigen(planes[n].normal);
            walls.mirrors.push_back(wall);
        }
    }
    return walls;
}

}  // namespace him
