// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/dielectrics.H"

#include "foamPoissonMesh/insulatingWallFvPatchScalarField.H"

#include "linear.H"
#include "syncTools.H"

namespace him {

namespace {

using namespace Foam;

const dimensionSet dimSurfaceCharge(0, -2, 1, 0, 0, 1, 0);

/// More digits than a double has.
constexpr unsigned int allDigits = 17;

}  // namespace

dielectrics::dielectrics(double permittivity, volScalarField& potential)
    : permittivity_(permittivity),
      relative_(IOobject("permittivityOverGas", potential.time().timeName(), potential.mesh()), potential.mesh(),
                dimensionedScalar("one", dimless, 1.0)),
      ratio_(IOobject("permittivityRatio", potential.time().timeName(), potential.mesh()), potential.mesh(),
             dimensionedScalar("one", dimless, 1.0)),
      sigma_(IOobject("wallSurfaceCharge", potential.time().timeName(), potential.mesh(), IOobject::READ_IF_PRESENT),
             potential.mesh(), dimensionedScalar(dimSurfaceCharge, Zero)),
      continued_(
          returnReduce(IOobject("wallSurfaceCharge", potential.time().timeName(), potential.mesh(), IOobject::MUST_READ)
                           .typeHeaderOk<surfaceScalarField>(true),
                       andOp<bool>()))
{
}

double dielectrics::chargeOf(const specialFace& face) const
{
    return face.patch < 0 ? sigma_[face.index] : sigma_.boundaryField()[face.patch][face.index];
}

double& dielectrics::chargeOf(const specialFace& face)
{
    return face.patch < 0 ? sigma_[face.index] : sigma_.boundaryFieldRef()[face.patch][face.index];
}

Foam::label dielectrics::meshFaceOf(const specialFace& face) const
{
    return face.patch < 0 ? face.index : relative_.mesh().boundary()[face.patch].start() + face.index;
}

bool dielectrics::isInside(const specialFace& face)
{
    return face.wall >= 0 && face.own + face.across > 0;
}

void dielectrics::addShares(Scalars& cellCharge) const
{
    for (const specialFace& face : faces_) {
        if (!isInside(face)) {
            continue;
        }
        const double perSide = chargeOf(face) * face.area / (face.own + face.across);
        cellCharge[face.cell] += face.own * perSide;
        if (face.other >= 0) {
            cellCharge[face.other] += face.across * perSide;
        }
    }
}

std::vector<scalarField> dielectrics::valuesAcross(const volScalarField& potential) const
{
    std::vector<scalarField> across(static_cast<std::size_t>(potential.boundaryField().size()));
    for (const specialFace& face : faces_) {
        scalarField& values = across[face.patch < 0 ? 0 : static_cast<std::size_t>(face.patch)];
        if (face.patch >= 0 && values.empty() && potential.boundaryField()[face.patch].coupled()) {
            values = potential.boundaryField()[face.patch].patchNeighbourField();
        }
    }
    return across;
}

double dielectrics::valueAt(const specialFace& face, const volScalarField& potential,
                            const std::vector<scalarField>& across) const
{
    const double there =
        face.patch < 0 ? potential[face.other] : across[static_cast<std::size_t>(face.patch)][face.index];
    return (face.own * potential[face.cell] + face.across * there) / (face.own + face.across);
}

tmp<surfaceScalarField> dielectrics::faceValues(const volScalarField& potential) const
{
    tmp<surfaceScalarField> values = linear<scalar>(potential.mesh()).interpolate(potential);
    surfaceScalarField& faces = values.ref();
    const std::vector<scalarField> across = valuesAcross(potential);
    for (const specialFace& face : faces_) {
        if (face.own + face.across == 0) {
            continue;  // the patch itself knows
        }
        const double charge = face.wall < 0 ? 0 : chargeOf(face);
        const double value = valueAt(face, potential, across) + charge / (permittivity_ * (face.own + face.across));
        (face.patch < 0 ? faces[face.index] : faces.boundaryFieldRef()[face.patch][face.index]) = value;
    }
    return values;
}

void dielectrics::updatePatches(volScalarField& potential) const
{
    forAll(potential.boundaryField(), patch)
    {
        auto* wall = dynamic_cast<insulatingWallFvPatchScalarField*>(&potential.boundaryFieldRef()[patch]);
        if (wall) {
            wall->setCharge(sigma_.boundaryField()[patch],
                            permittivity_ * relative_.boundaryField()[patch].patchInternalField());
        }
    }
}

bool dielectrics::insideMesh(label owned) const
{
    return isInside(faces_[owned_[static_cast<std::size_t>(owned)]]);
}

label dielectrics::cellOf(label owned) const
{
    return faces_[owned_[static_cast<std::size_t>(owned)]].cell;
}

Foam::face dielectrics::polygonOf(label owned) const
{
    return relative_.mesh().faces()[meshFaceOf(faces_[owned_[static_cast<std::size_t>(owned)]])];
}

double dielectrics::surfaceCharge(label owned) const
{
    return chargeOf(faces_[owned_[static_cast<std::size_t>(owned)]]);
}

double dielectrics::faceValue(label owned, const surfaceScalarField& values) const
{
    const specialFace& face = faces_[owned_[static_cast<std::size_t>(owned)]];
    return face.patch < 0 ? values[face.index] : values.boundaryField()[face.patch][face.index];
}

void dielectrics::addCharge(const Scalars& charge)
{
    const fvMesh& mesh = relative_.mesh();
    scalarField gained(mesh.nFaces(), Zero);  // [C/m2]
    for (std::size_t n = 0; n < owned_.size(); ++n) {
        const specialFace& face = faces_[owned_[n]];
        gained[meshFaceOf(face)] = charge[static_cast<Index>(n)] / face.area;
    }
    syncTools::syncFaceList(mesh, gained, plusEqOp<scalar>());
    for (const specialFace& face : faces_) {
        if (face.wall >= 0) {
            chargeOf(face) += gained[meshFaceOf(face)];
        }
    }
}

std::vector<double> dielectrics::totals() const
{
    scalarList sums(static_cast<label>(names_.size()), Zero);
    for (const std::size_t n : owned_) {
        sums[faces_[n].wall] += chargeOf(faces_[n]) * faces_[n].area;
    }
    for (scalar& total : sums) {
        reduce(total, sumOp<scalar>());
    }
    return {sums.begin(), sums.end()};
}

void dielectrics::write() const
{
    const unsigned int digits = IOstream::defaultPrecision(allDigits);
    surfaceScalarField now(
        IOobject(sigma_.name(), sigma_.time().timeName(), sigma_.mesh(), IOobject::NO_READ, IOobject::NO_WRITE, false),
        sigma_);
    now.write();
    IOstream::defaultPrecision(digits);
}

}  // namespace him
