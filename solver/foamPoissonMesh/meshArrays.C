// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/meshArrays.H"

#include "foamPoissonMesh/conversions.H"
#include "foamPoissonMesh/insulatingWallFvPatchScalarField.H"
#include "settings/electricRegion.H"

#include "basicSymmetryFvPatchField.H"
#include "cyclicPolyPatch.H"
#include "fixedGradientFvPatchFields.H"
#include "fvMesh.H"
#include "mixedFvPatchFields.H"
#include "processorCyclicPolyPatch.H"
#include "zeroGradientFvPatchFields.H"

#include <algorithm>

namespace him {

namespace {

using namespace Foam;

bool isInsulated(const fvPatchScalarField& potential)
{
    if (const auto* gradient = dynamic_cast<const fixedGradientFvPatchScalarField*>(&potential)) {
        const scalarField& values = gradient->gradient();
        return std::all_of(values.begin(), values.end(), [](scalar value) { return value == 0; });
    }
    return isA<zeroGradientFvPatchScalarField>(potential) || isA<basicSymmetryFvPatchField<scalar>>(potential);
}

/// Why cells on both sides of this coupled patch cannot be neighbours as p3m needs it; empty when they can.
std::string whyNotCoupled(const fvPatchScalarField& potential)
{
    const polyPatch& patch = potential.patch().patch();
    if (!isA<processorPolyPatch>(patch) && !isA<cyclicPolyPatch>(patch)) {
        return "a patch of type " + patch.type()
               + ", whose faces have no single cell on the other side. Use cyclic patches with matching faces";
    }
    if (potential.type() != patch.type()) {
        return "the condition " + potential.type() + " on a patch of type " + patch.type()
               + ". A jump of the potential between periodic copies is not modelled; use " + patch.type();
    }
    if (!refCast<const coupledPolyPatch>(patch).parallel()) {
        return "a periodic patch with rotation. The copies of a charge must all stand in the same direction; use a "
               "cyclic patch with transform translational, or the whole geometry";
    }
    return {};
}

/// Why p3m does not know what this patch does; empty when it does, or when the patch is coupled.
std::string whyNotCondition(const fvPatchScalarField& potential)
{
    if (potential.coupled() || isConductor(potential) || isInsulated(potential)) {
        return {};
    }
    if (isA<insulatingWallFvPatchScalarField>(potential)) {
        return "the condition insulatingWall, of whose other side p3m knows nothing";
    }
    return "the condition " + potential.type() + ", of which p3m does not know whether the wall is a conductor";
}

/// What to do about such a patch, a sentence.
std::string adviceOn(const fvPatchScalarField& potential)
{
    if (isA<insulatingWallFvPatchScalarField>(potential)) {
        return "Mesh the outside of the wall and name it in insulatingWalls, or use fieldMethod him or himCell";
    }
    return "Known: fixedValue and its kin, zeroGradient, fixedGradient with gradient 0, symmetry, symmetryPlane, "
           "cyclic. Use one of "
           "them, or fieldMethod him or himCell";
}

/// The text of the first rank that has one. Collective.
std::string onAnyRank(const std::string& mine)
{
    List<string> texts(Pstream::nProcs());
    texts[Pstream::myProcNo()] = mine;
    Pstream::gatherList(texts);
    Pstream::scatterList(texts);
    const auto found = std::find_if(texts.begin(), texts.end(), [](const auto& text) { return !text.empty(); });
    return found == texts.end() ? std::string() : std::string(*found);
}

/// Complains about the patches for which `whyNot` has a reason. Collective.
template <class WhyNot> void refusePatches(const volScalarField& potential, Complaints& complaints, WhyNot&& whyNot)
{
    const std::string where = ofRegion(potential.time().timeName(), potential.mesh().name()) / "electricPotential";
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        // A gradient of zero on this rank's faces says nothing about the others.
        const bool common = !isA<processorPolyPatch>(patch.patch().patch());
        const std::string reason = common ? onAnyRank(whyNot(patch)) : whyNot(patch);
        if (!reason.empty()) {
            complaints.add(where + ": " + patch.patch().name(), "found " + reason + ".");
        }
    }
}

/// Translation from the cells beyond the patch to where this side sees them; exactly zero at plain rank boundaries.
vector shiftOf(const fvPatch& patch)
{
    const polyPatch& faces = patch.patch();
    if (patch.size() == 0 || (isA<processorPolyPatch>(faces) && !isA<processorCyclicPolyPatch>(faces))) {
        return Zero;
    }
    const vectorField& others = isA<processorPolyPatch>(faces)
                                    ? refCast<const processorPolyPatch>(faces).neighbFaceCentres()
                                    : refCast<const cyclicPolyPatch>(faces).neighbPatch().faceCentres();
    // Components that differ by round-off alone must not look like a tiny translation.
    vector shift = average(vectorField(faces.faceCentres() - others));
    for (direction component = 0; component < vector::nComponents; ++component) {
        if (std::abs(shift[component]) < 1e-9 * mag(shift)) {
            shift[component] = 0;
        }
    }
    return shift;
}

void addCoupledFaces(const fvPatchScalarField& potential, CoupledFaces& faces)
{
    const fvPatch& patch = potential.patch();
    const fvMesh& mesh = patch.boundaryMesh().mesh();
    const labelList ownCells = identity(mesh.nCells());
    const labelField otherCells =
        refCast<const lduInterface>(patch).internalFieldTransfer(Pstream::commsTypes::blocking, ownCells);
    const auto* processor = dynamic_cast<const processorPolyPatch*>(&patch.patch());
    const int rank = processor ? processor->neighbProcNo() : Pstream::myProcNo();
    const vector shift = shiftOf(patch);

    Index row = faces.size();
    const Index all = row + patch.size();
    faces.centre.conservativeResize(all, 3);
    faces.areaVector.conservativeResize(all, 3);
    faces.shift.conservativeResize(all, 3);
    forAll(patch, i)
    {
        faces.centre.row(row) = toEigen(patch.Cf()[i]).transpose().array();
        faces.areaVector.row(row) = toEigen(patch.Sf()[i]).transpose().array();
        faces.shift.row(row) = toEigen(shift).transpose().array();
        faces.cell.push_back(patch.faceCells()[i]);
        faces.otherRank.push_back(rank);
        faces.otherCell.push_back(otherCells[i]);
        ++row;
    }
}

scalar radiusOf(const fvPatch& patch, label i)
{
    scalar largest = 0;
    for (const label point : patch.patch()[i]) {
        largest = max(largest, magSqr(patch.patch().points()[point] - patch.Cf()[i]));
    }
    return std::sqrt(largest);
}

void addBoundaryFaces(const fvPatchScalarField& potential, BoundaryFaces& faces)
{
    const fvPatch& patch = potential.patch();
    const bool conductor = isConductor(potential);
    const FaceCondition condition = conductor                ? FaceCondition::conductor
                                    : isInsulated(potential) ? FaceCondition::insulated
                                                             : FaceCondition::other;
    Index row = faces.size();
    const Index all = row + patch.size();
    faces.centre.conservativeResize(all, 3);
    faces.normal.conservativeResize(all, 3);
    faces.area.conservativeResize(all);
    faces.radius.conservativeResize(all);
    faces.value.conservativeResize(all);
    forAll(patch, i)
    {
        faces.centre.row(row) = toEigen(patch.Cf()[i]).transpose().array();
        faces.normal.row(row) = toEigen(patch.Sf()[i] / patch.magSf()[i]).transpose().array();
        faces.area[row] = patch.magSf()[i];
        faces.radius[row] = radiusOf(patch, i);
        faces.value[row] = conductor ? potential[i] : 0;
        faces.cell.push_back(patch.faceCells()[i]);
        faces.condition.push_back(condition);
        ++row;
    }
}

InternalFaces internalFacesOf(const fvMesh& mesh)
{
    InternalFaces faces;
    faces.centre.resize(mesh.nInternalFaces(), 3);
    faces.areaVector.resize(mesh.nInternalFaces(), 3);
    for (label face = 0; face < mesh.nInternalFaces(); ++face) {
        faces.centre.row(face) = toEigen(mesh.faceCentres()[face]).transpose().array();
        faces.areaVector.row(face) = toEigen(mesh.faceAreas()[face]).transpose().array();
        faces.owner.push_back(mesh.faceOwner()[face]);
        faces.neighbour.push_back(mesh.faceNeighbour()[face]);
    }
    return faces;
}

}  // namespace

bool isConductor(const fvPatchScalarField& potential)
{
    // Mixed conditions say that they fix the value, whatever their value fraction is.
    return potential.fixesValue() && !isA<mixedFvPatchScalarField>(potential);
}

void refuseCouplings(const volScalarField& potential, Complaints& complaints)
{
    refusePatches(potential, complaints, [](const fvPatchScalarField& patch) {
        return patch.coupled() ? whyNotCoupled(patch) : std::string();
    });
}

void refuseConditionsUnknownToP3m(const volScalarField& potential, Complaints& complaints)
{
    refusePatches(potential, complaints, [](const fvPatchScalarField& patch) {
        const std::string reason = patch.coupled() ? whyNotCoupled(patch) : whyNotCondition(patch);
        return patch.coupled() || reason.empty() ? reason : reason + ". " + adviceOn(patch);
    });
}

std::string firstConditionUnknownToP3m(const volScalarField& potential)
{
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        if (isA<processorPolyPatch>(patch.patch().patch())) {
            break;  // ranks have their own ones, behind the patches that all have
        }
        const std::string reason = onAnyRank(whyNotCondition(patch));
        if (!reason.empty()) {
            return "patch " + patch.patch().name() + " has " + reason;
        }
    }
    return {};
}

MeshArrays makeMeshArrays(const volScalarField& potential)
{
    const fvMesh& mesh = potential.mesh();
    MeshArrays arrays;
    arrays.centre.resize(mesh.nCells(), 3);
    arrays.volume.resize(mesh.nCells());
    arrays.radius.resize(mesh.nCells());
    for (label cell = 0; cell < mesh.nCells(); ++cell) {
        arrays.centre.row(cell) = toEigen(mesh.cellCentres()[cell]).transpose().array();
        arrays.volume[cell] = mesh.V()[cell];
        scalar farthest = 0;
        for (const label point : mesh.cellPoints()[cell]) {
            farthest = max(farthest, magSqr(mesh.points()[point] - mesh.cellCentres()[cell]));
        }
        arrays.radius[cell] = std::sqrt(farthest);
    }
    arrays.internal = internalFacesOf(mesh);
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        if (!patch.coupled()) {
            addBoundaryFaces(patch, arrays.boundary);
        }
    }
    const labelList ownCells = identity(mesh.nCells());
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        if (patch.coupled()) {
            // Sends are buffered, so that all of them can go out before the first receive.
            refCast<const lduInterface>(patch.patch()).initInternalFieldTransfer(Pstream::commsTypes::blocking, ownCells);
        }
    }
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        if (patch.coupled()) {
            addCoupledFaces(patch, arrays.coupled);
        }
    }
    return arrays;
}

void updateVoltages(volScalarField& potential, MeshArrays& arrays)
{
    Index row = 0;
    for (fvPatchScalarField& patch : potential.boundaryFieldRef()) {
        if (patch.coupled()) {
            continue;
        }
        if (isConductor(patch)) {
            patch.evaluate();
            forAll(patch, i)
            {
                arrays.boundary.value[row + i] = patch[i];
            }
        }
        row += patch.size();
    }
}

}  // namespace him
