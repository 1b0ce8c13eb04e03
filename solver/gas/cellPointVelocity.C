// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/cellPointVelocity.H"

#include "foamPoissonMesh/conversions.H"

#include "syncTools.H"

namespace him {

using namespace Foam;

namespace {

/// Mean of the values at a face's corners.
template <class Values> vector average(const face& corners, const Values& values)
{
    vector sum = Zero;
    for (const label corner : corners) {
        sum += values[corner];
    }
    return sum / scalar(corners.size());
}

}  // namespace

cellPointVelocity::cellPointVelocity(const volVectorField& U, bool followsPatches)
    : U_(U),
      followed_(U.boundaryField().size(), false),
      onPatch_(U.mesh().nPoints(), false),
      weight_(U.mesh().nPoints(), 0),
      cells_(U.mesh().nCells(), Zero),
      points_(U.mesh().nPoints(), Zero)
{
    const fvMesh& mesh = U.mesh();
    forAll(followed_, patch)
    {
        followed_[patch] = followsPatches && !U.boundaryField()[patch].coupled();
    }
    forPatchFaces([&](label point, label, label, scalar weight) { weight_[point] += weight; });
    scalarField ofPatches(weight_);
    syncTools::syncPointList(mesh, ofPatches, plusEqOp<scalar>(), scalar(0));
    forAll(onPatch_, point)
    {
        onPatch_[point] = ofPatches[point] > 0;
    }
    forPointCells([&](label point, label, scalar weight) { weight_[point] += weight; });
    syncTools::syncPointList(mesh, weight_, plusEqOp<scalar>(), scalar(0));
}

template <class Add> void cellPointVelocity::forPatchFaces(Add add) const
{
    const fvMesh& mesh = U_.mesh();
    forAll(followed_, patch)
    {
        const polyPatch& faces = mesh.boundaryMesh()[patch];
        for (label face = 0; followed_[patch] && face < faces.size(); ++face) {
            for (const label point : faces[face]) {
                add(point, patch, face, 1 / mag(mesh.points()[point] - faces.faceCentres()[face]));
            }
        }
    }
}

template <class Add> void cellPointVelocity::forPointCells(Add add) const
{
    const fvMesh& mesh = U_.mesh();
    const labelListList& around = mesh.pointCells();
    forAll(around, point)
    {
        for (label n = 0; !onPatch_[point] && n < around[point].size(); ++n) {
            const label cell = around[point][n];
            add(point, cell, 1 / mag(mesh.points()[point] - mesh.cellCentres()[cell]));
        }
    }
}

void cellPointVelocity::update(const Points& velocity)
{
    const fvMesh& mesh = U_.mesh();
    forAll(cells_, cell)
    {
        cells_[cell] = toFoam(Vector3(velocity.row(cell).matrix().transpose()));
    }
    points_ = Zero;
    forPatchFaces([&](label point, label patch, label face, scalar weight) {
        points_[point] += weight * U_.boundaryField()[patch][face];
    });
    forPointCells([&](label point, label cell, scalar weight) { points_[point] += weight * cells_[cell]; });
    syncTools::syncPointList(mesh, points_, plusEqOp<vector>(), vector::zero);
    points_ /= weight_;
}

Vector3 cellPointVelocity::deviation(Index cell, const Vector3& point) const
{
    const fvMesh& mesh = U_.mesh();
    const Foam::point& centre = mesh.cellCentres()[static_cast<label>(cell)];
    const vector& mean = cells_[static_cast<label>(cell)];
    const vector place = toFoam(point) - centre;
    // A point on a boundary between tetrahedra is inside none of them to rounding: the best one counts.
    scalar best = -VGREAT;
    vector found = Zero;
    for (const label index : mesh.cells()[static_cast<label>(cell)]) {
        const face& corners = mesh.faces()[index];
        const vector middle = average(corners, mesh.points()) - centre;
        label previous = corners.last();
        for (const label next : corners) {
            const vector a = mesh.points()[previous] - centre;
            const vector b = mesh.points()[next] - centre;
            const scalar volume = middle & (a ^ b);
            if (mag(volume) > SMALL * mesh.cellVolumes()[static_cast<label>(cell)]) {
                const scalar ofMiddle = (place & (a ^ b)) / volume;
                const scalar ofA = (middle & (place ^ b)) / volume;
                const scalar ofB = (middle & (a ^ place)) / volume;
                const scalar inside = min(min(ofMiddle, ofA), min(ofB, 1 - ofMiddle - ofA - ofB));
                if (inside > best) {
                    best = inside;
                    found = ofMiddle * (average(corners, points_) - mean) + ofA * (points_[previous] - mean)
                            + ofB * (points_[next] - mean);
                }
                if (inside >= 0) {
                    return toEigen(found);
                }
            }
            previous = next;
        }
    }
    return toEigen(found);
}

}  // namespace him
