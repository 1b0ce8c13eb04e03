// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/faceReconstruction.H"

#include "extrapolatedCalculatedFvPatchFields.H"
#include "fvcSurfaceIntegrate.H"

namespace him {

using namespace Foam;

faceReconstruction::faceReconstruction(const fvMesh& mesh)
    : normal_("faceNormal", mesh.Sf() / mesh.magSf()),
      inverse_(IOobject("reconstruction", mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::NO_WRITE, false), mesh,
               dimensionedTensor(inv(dimArea), Zero))
{
    const volTensorField sum(fvc::surfaceSum(normal_ * mesh.Sf()));
    forAll(sum, cell)
    {
        inverse_[cell] = inv(sum[cell]);
    }
}

tmp<volVectorField> faceReconstruction::operator()(const surfaceScalarField& flux) const
{
    const fvMesh& mesh = inverse_.mesh();
    tmp<volVectorField> result(new volVectorField(
        IOobject("reconstruct(" + flux.name() + ')', flux.instance(), mesh, IOobject::NO_READ, IOobject::NO_WRITE, false), mesh,
        dimensionedVector(flux.dimensions() / dimArea, Zero), extrapolatedCalculatedFvPatchVectorField::typeName));
    const volVectorField sum(fvc::surfaceSum(normal_ * flux));
    forAll(sum, cell)
    {
        result.ref()[cell] = inverse_[cell] & sum[cell];
    }
    result.ref().correctBoundaryConditions();
    return result;
}

}  // namespace him
