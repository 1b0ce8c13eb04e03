// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/foamPoissonMesh.H"

#include "foamPoissonMesh/conversions.H"
#include "settings/checkedDictionary.H"

#include "extrapolatedCalculatedFvPatchFields.H"
#include "fvScalarMatrix.H"
#include "fvcGrad.H"
#include "fvmLaplacian.H"

#include <stdexcept>

namespace him {

namespace {

using namespace Foam;

const dimensionSet dimPotential(1, 2, -3, 0, 0, -1, 0);
const dimensionSet dimPermittivity(-1, -3, 4, 0, 0, 2, 0);
const dimensionSet dimCharge(0, 0, 1, 0, 0, 1, 0);

/// A net charge above this share of all charges counts as one.
constexpr double neutrality = 1e-9;

IOobject fieldIO(const word& name, const fvMesh& mesh, IOobject::readOption read)
{
    return IOobject(name, mesh.time().timeName(), mesh, read, IOobject::AUTO_WRITE);
}

Box boundsOf(const pointField& points)
{
    Box bounds;
    for (const point& p : points) {
        bounds.extend(toEigen(p));
    }
    return bounds;
}

/// Largest distance between two points of one cell, over all ranks [m].
double largestDiagonal(const fvMesh& mesh)
{
    scalar largest = 0;
    for (label cell = 0; cell < mesh.nCells(); ++cell) {
        const labelList& points = mesh.cellPoints()[cell];
        forAll(points, i)
        {
            for (label j = 0; j < i; ++j) {
                largest = max(largest, magSqr(mesh.points()[points[i]] - mesh.points()[points[j]]));
            }
        }
    }
    return std::sqrt(returnReduce(largest, maxOp<scalar>()));
}

}  // namespace

foamPoissonMesh::foamPoissonMesh(const Foam::fvMesh& mesh, double permittivity)
    : mesh_(mesh),
      permittivity_("permittivity", dimPermittivity, permittivity),
      nonOrthogonalCorrectors_(
          mesh.solutionDict().subOrEmptyDict("HIM").lookupOrDefault("nNonOrthogonalCorrectors", 0)),
      electricPotential_(fieldIO("electricPotential", mesh, IOobject::MUST_READ), mesh),
      chargeDensity_(fieldIO("chargeDensity", mesh, IOobject::NO_READ), mesh,
                     dimensionedScalar(dimCharge / dimVolume, Zero),
                     extrapolatedCalculatedFvPatchScalarField::typeName),
      electricField_(fieldIO("electricField", mesh, IOobject::NO_READ), mesh,
                     dimensionedVector(dimPotential / dimLength, Zero),
                     extrapolatedCalculatedFvPatchVectorField::typeName),
      locator_(mesh),
      localBounds_(boundsOf(mesh.points())),
      largestCellDiagonal_(largestDiagonal(mesh)),
      potentialIsFixed_(!electricPotential_.needReference())
{
}

Vector3 foamPoissonMesh::cellCentre(Index cell) const
{
    // Not C(), which is built by all ranks together when it is first asked for.
    return toEigen(mesh_.cellCentres()[static_cast<label>(cell)]);
}

Vector3 foamPoissonMesh::electricField(Index cell) const
{
    return toEigen(electricField_[static_cast<label>(cell)]);
}

double foamPoissonMesh::potential(Index cell) const
{
    return electricPotential_[static_cast<label>(cell)];
}

Box foamPoissonMesh::globalBounds() const
{
    Box box;
    box.lower = toEigen(mesh_.bounds().min());
    box.upper = toEigen(mesh_.bounds().max());
    return box;
}

void foamPoissonMesh::refuseNetCharge(const Scalars& cellCharge) const
{
    const scalar net = returnReduce(scalar(cellCharge.sum()), sumOp<scalar>());
    const scalar all = returnReduce(scalar(cellCharge.abs().sum()), sumOp<scalar>());
    if (std::abs(net) > neutrality * all) {
        throw std::runtime_error(
            "no patch of 0/electricPotential fixes the voltage, but the mesh holds a net charge of " + shown(net)
            + " C, whose field lines have nowhere to end. Give one patch a fixedValue.");
    }
}

void foamPoissonMesh::solve(const Scalars& cellCharge)
{
    if (!potentialIsFixed_) {
        refuseNetCharge(cellCharge);
    }
    forAll(chargeDensity_, cell)
    {
        chargeDensity_[cell] = cellCharge[cell] / mesh_.V()[cell];
    }
    chargeDensity_.correctBoundaryConditions();

    for (int corrector = 0; corrector <= nonOrthogonalCorrectors_; ++corrector) {
        fvScalarMatrix potentialEqn(fvm::laplacian(electricPotential_) == -chargeDensity_ / permittivity_);
        potentialEqn.setReference(0, 0);  // does nothing where a patch fixes the potential
        const solverPerformance performance = potentialEqn.solve();
        if (!performance.converged()) {
            throw std::runtime_error("the potential did not converge: " + performance.solverName() + " stopped after "
                                     + std::to_string(performance.nIterations()) + " iterations at a residual of "
                                     + shown(performance.finalResidual())
                                     + ". Raise maxIter or tolerance, or choose another solver, in "
                                     + "solvers.electricPotential of system/fvSolution.");
        }
    }
    electricField_ = -fvc::grad(electricPotential_);
}

}  // namespace him
