// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/foamGasMesh.H"

#include "foamPoissonMesh/conversions.H"
#include "settings/checkedDictionary.H"

#include "IStringStream.H"
#include "fvm.H"
#include "gaussLaplacianScheme.H"
#include "surfaceFields.H"
#include "volFields.H"
#include "zeroGradientFvPatchFields.H"

namespace him {

namespace {

/// Of the diffusion's linear solve, relative: what it leaves undone is a share of the solid volume.
constexpr double tolerance = 1e-14;

}  // namespace

foamGasMesh::foamGasMesh(const Foam::fvMesh& mesh) : mesh_(mesh), locator_(mesh)
{
    for (const Foam::point& p : mesh_.points()) {
        bounds_.extend(toEigen(p));
    }
    for (Foam::label cell = 0; cell < mesh_.nCells(); ++cell) {
        Box box;
        for (const Foam::label point : mesh_.cellPoints()[cell]) {
            box.extend(toEigen(mesh_.points()[point]));
        }
        largestDiagonal_ = std::max(largestDiagonal_, box.size().norm());
    }
    Foam::reduce(largestDiagonal_, Foam::maxOp<double>());
}

Vector3 foamGasMesh::cellCentre(Index cell) const
{
    return toEigen(mesh_.cellCentres()[static_cast<Foam::label>(cell)]);
}

void foamGasMesh::smooth(Scalars& perVolume, double length) const
{
    using namespace Foam;
    volScalarField spread(
        IOobject("spread", mesh_.time().timeName(), mesh_, IOobject::NO_READ, IOobject::NO_WRITE, false), mesh_,
        dimensionedScalar(dimless, Zero), zeroGradientFvPatchScalarField::typeName);
    forAll(spread, cell)
    {
        spread[cell] = perVolume[cell];
    }
    volScalarField source("spreadSource", spread);
    spread.correctBoundaryConditions();
    // Here and not in system/fvSchemes: the conservation of solid volume must not hang on it. Uncorrected, so that it stays its own
    // adjoint and makes nothing negative where faces stand askew; the length is a choice anyway.
    IStringStream words("linear uncorrected");
    fv::gaussLaplacianScheme<scalar, scalar> scheme(mesh_, words);
    const surfaceScalarField area(
        IOobject("area", mesh_.time().timeName(), mesh_, IOobject::NO_READ, IOobject::NO_WRITE, false), mesh_,
        dimensionedScalar("area", dimArea, 0.25 * length * length));
    fvScalarMatrix equation(fvm::Sp(dimensionedScalar("one", dimless, 1), spread) - scheme.fvmLaplacian(area, spread)
                            == source);
    dictionary controls;
    controls.add("solver", word("PCG"));
    controls.add("preconditioner", word("DIC"));
    controls.add("tolerance", tolerance);
    controls.add("relTol", scalar(0));
    if (!equation.solve(controls).converged()) {
        throw std::runtime_error("the solid volume could not be spread over smoothingLength " + shown(length)
                                 + " m: the equation does not converge. Look for cells without volume (checkMesh).");
    }
    forAll(spread, cell)
    {
        perVolume[cell] = spread[cell];
    }
}

}  // namespace him
