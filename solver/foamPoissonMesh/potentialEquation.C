// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/potentialEquation.H"

#include "settings/checkedDictionary.H"
#include "settings/electricRegion.H"

#include "IStringStream.H"
#include "gaussGrad.H"
#include "gradScheme.H"
#include "linear.H"
#include "surfaceFields.H"

#include <stdexcept>

namespace him {

namespace {

using namespace Foam;

/// A mesh with smaller non-orthogonal parts of its unit normals than this is orthogonal up to round-off.
constexpr double straight = 1e-9;

/// Below this many cells there is too little to agglomerate.
constexpr label smallMesh = 1000;

/// How often the non-orthogonal part is repeated at most, when the case does not say.
constexpr long mostCorrectors = 50;

/// An increment is solved to a tenth of itself at least, however small it is.
constexpr double loosestIncrement = 0.1;

dictionary defaultSolver(const fvMesh& mesh)
{
    dictionary controls;
    if (returnReduce(mesh.nCells(), sumOp<label>()) < smallMesh) {
        controls.add("solver", word("PCG"));
        controls.add("preconditioner", word("DIC"));
    } else {
        controls.add("solver", word("GAMG"));
        controls.add("smoother", word("GaussSeidel"));
    }
    return controls;
}

bool isOrthogonal(const fvMesh& mesh)
{
    scalar largest = 0;
    for (const vector& part : mesh.nonOrthCorrectionVectors().primitiveField()) {
        largest = max(largest, mag(part));
    }
    for (const fvsPatchVectorField& patch : mesh.nonOrthCorrectionVectors().boundaryField()) {
        for (const vector& part : patch) {
            largest = max(largest, mag(part));
        }
    }
    return returnReduce(largest, maxOp<scalar>()) < straight;
}

/// The rank whose first cell is the reference of a potential that nothing fixes.
bool holdsReference(const fvMesh& mesh)
{
    const label none = Pstream::nProcs();
    return returnReduce(mesh.nCells() > 0 ? Pstream::myProcNo() : none, minOp<label>()) == Pstream::myProcNo();
}

}  // namespace

potentialEquation::potentialEquation(volScalarField& potential, const potentialNumerics& numerics,
                                     const dielectrics* matter)
    : potential_(potential), numerics_(numerics), matter_(matter), orthogonal_(isOrthogonal(potential.mesh()))
{
    if (numerics_.solver.empty()) {
        numerics_.solver = defaultSolver(potential.mesh());
    }
    if (numerics_.nonOrthogonalLimit == 0) {
        orthogonal_ = true;
    }
}

tmp<scalarField> potentialEquation::ratioAt(label patch) const
{
    return matter_ ? tmp<scalarField>(new scalarField(matter_->ratio().boundaryField()[patch]))
                   : tmp<scalarField>(new scalarField(potential_.boundaryField()[patch].size(), scalar(1)));
}

void potentialEquation::assemble()
{
    const fvMesh& mesh = potential_.mesh();
    const surfaceScalarField& coeffs = numerics_.minimumCorrection ? mesh.deltaCoeffs() : mesh.nonOrthDeltaCoeffs();
    solver_.clear();
    matrix_ = std::make_unique<fvScalarMatrix>(potential_, potential_.dimensions() * dimLength);
    matrix_->upper() = coeffs.primitiveField() * mesh.magSf().primitiveField();
    if (matter_) {
        matrix_->upper() *= matter_->ratio().primitiveField();
    }
    matrix_->negSumDiag();
    forAll(potential_.boundaryField(), patch)
    {
        const fvPatchScalarField& values = potential_.boundaryField()[patch];
        const scalarField area(mesh.magSf().boundaryField()[patch] * ratioAt(patch));
        const scalarField& inverse = coeffs.boundaryField()[patch];
        matrix_->internalCoeffs()[patch] =
            values.coupled() ? area * values.gradientInternalCoeffs(inverse) : area * values.gradientInternalCoeffs();
        matrix_->boundaryCoeffs()[patch] =
            values.coupled() ? -area * values.gradientBoundaryCoeffs(inverse) : -area * values.gradientBoundaryCoeffs();
        const labelUList& cells = values.patch().faceCells();
        forAll(cells, i)
        {
            matrix_->diag()[cells[i]] += matrix_->internalCoeffs()[patch][i];
        }
    }
    if (potential_.needReference() && holdsReference(mesh)) {
        matrix_->diag()[0] += matrix_->diag()[0];
    }
    solver_ = lduMatrix::solver::New(potential_.name(), *matrix_, matrix_->boundaryCoeffs(), matrix_->internalCoeffs(),
                                     potential_.boundaryField().scalarInterfaces(), numerics_.solver);
}

bool potentialEquation::coefficientsAreOld() const
{
    bool changed = !matrix_;
    for (label patch = 0; matrix_ && patch < potential_.boundaryField().size(); ++patch) {
        const fvPatchScalarField& values = potential_.boundaryField()[patch];
        if (!values.coupled()) {
            const scalarField now(scalarField(values.patch().magSf() * ratioAt(patch)) * values.gradientInternalCoeffs());
            changed = changed || now != matrix_->internalCoeffs()[patch];
        }
    }
    return returnReduce(changed, orOp<bool>());
}

tmp<volVectorField> potentialEquation::gradient() const
{
    if (matter_) {
        tmp<volVectorField> result = fv::gaussGrad<scalar>::gradf(matter_->faceValues(potential_), "grad(electricPotential)");
        fv::gaussGrad<scalar>::correctBoundaryConditions(potential_, result.ref());
        return result;
    }
    IStringStream text(numerics_.gradient);
    return fv::gradScheme<scalar>::New(potential_.mesh(), text)().grad(potential_);
}

scalarField potentialEquation::nonOrthogonalFlux() const
{
    const fvMesh& mesh = potential_.mesh();
    const surfaceVectorField faceGradient(linear<vector>(mesh).interpolate(gradient()));
    const double limit = numerics_.nonOrthogonalLimit;
    // The explicit part of the flux, limited against the implicit part.
    const auto flux = [&](scalar area, const vector& part, const vector& gradient, scalar implicit) {
        const scalar correction = part & gradient;
        const scalar limiter = limit * mag(implicit) / ((1 - limit) * mag(correction) + SMALL);
        return area * correction * min(limiter, scalar(1));
    };
    scalarField sums(mesh.nCells(), Zero);
    for (label face = 0; face < mesh.nInternalFaces(); ++face) {
        const label owner = mesh.owner()[face];
        const label neighbour = mesh.neighbour()[face];
        const scalar implicit = mesh.nonOrthDeltaCoeffs()[face] * (potential_[neighbour] - potential_[owner]);
        const scalar area = matter_ ? mesh.magSf()[face] * matter_->ratio()[face] : mesh.magSf()[face];
        const scalar f = flux(area, mesh.nonOrthCorrectionVectors()[face], faceGradient[face], implicit);
        sums[owner] += f;
        sums[neighbour] -= f;
    }
    forAll(potential_.boundaryField(), patch)
    {
        const fvPatchScalarField& values = potential_.boundaryField()[patch];
        if (!values.coupled()) {
            continue;  // the fluxes at the edge of the mesh have no such part
        }
        const scalarField implicit(values.snGrad(mesh.nonOrthDeltaCoeffs().boundaryField()[patch]));
        const scalarField area(mesh.magSf().boundaryField()[patch] * ratioAt(patch));
        forAll(values, i)
        {
            sums[values.patch().faceCells()[i]] +=
                flux(area[i], mesh.nonOrthCorrectionVectors().boundaryField()[patch][i],
                     faceGradient.boundaryField()[patch][i], implicit[i]);
        }
    }
    return sums;
}

double potentialEquation::boundaryFlux() const
{
    scalar sum = 0;
    forAll(potential_.boundaryField(), patch)
    {
        const fvPatchScalarField& values = potential_.boundaryField()[patch];
        if (!values.coupled()) {
            sum += Foam::sum(values.patch().magSf() * ratioAt(patch) * values.gradientBoundaryCoeffs());
        }
    }
    return sum;
}

std::string potentialEquation::description() const
{
    return numerics_.solver.get<word>("solver") + " to a residual of " + shown(numerics_.tolerance)
           + (orthogonal_ ? "" : ", non-orthogonal");
}

solverPerformance potentialEquation::solveOnce(scalarField& values, const scalarField& source, double tolerance)
{
    dictionary controls(numerics_.solver);
    controls.set("tolerance", tolerance);
    solver_->read(controls);
    const solverPerformance performance = solver_->solve(values, source);
    if (told_ && solverPerformance::debug) {
        performance.print(Info.masterStream(potential_.mesh().comm()));
    }
    if (!performance.converged()) {
        const std::string file = ofRegion("system", potential_.mesh().name()) / "fvSolution";
        throw std::runtime_error(
            "the potential did not converge: " + performance.solverName() + " stopped after "
            + std::to_string(performance.nIterations()) + " iterations at a residual of " + shown(performance.finalResidual())
            + ". Raise maxIter or tolerance, or choose another solver, in solvers.electricPotential of " + file + ".");
    }
    return performance;
}

void potentialEquation::solve(const scalarField& source)
{
    volScalarField::Boundary& boundary = potential_.boundaryFieldRef();
    boundary.updateCoeffs();
    if (coefficientsAreOld()) {
        assemble();
    }
    scalarField total(source);
    forAll(boundary, patch)
    {
        const fvPatchScalarField& values = boundary[patch];
        if (!values.coupled()) {
            const scalarField flux(values.patch().magSf() * ratioAt(patch) * values.gradientBoundaryCoeffs());
            const labelUList& cells = values.patch().faceCells();
            forAll(cells, i)
            {
                total[cells[i]] -= flux[i];
            }
        }
    }
    norm_ = 2 * gSumMag(total);

    const long most = orthogonal_ ? 0 : numerics_.nonOrthogonalCorrectors.value_or(mostCorrectors);
    for (long corrector = 0; corrector <= most; ++corrector) {
        scalarField corrected(total);
        if (!orthogonal_) {
            corrected -= nonOrthogonalFlux();
        }
        const solverPerformance performance = solveOnce(potential_.primitiveFieldRef(), corrected, numerics_.tolerance);
        potential_.correctBoundaryConditions();
        if (!numerics_.nonOrthogonalCorrectors && performance.nIterations() == 0) {
            return;
        }
    }
    if (!orthogonal_ && !numerics_.nonOrthogonalCorrectors) {
        throw std::runtime_error("the non-orthogonal part of the potential did not settle in " + std::to_string(most)
                                 + " repetitions. Write limited 0.5 in place of corrected in laplacianSchemes of "
                                   "system/fvSchemes, raise the tolerance of solvers.electricPotential in "
                                   "system/fvSolution, or give a number of HIM.nNonOrthogonalCorrectors there.");
    }
}

void potentialEquation::solveIncrement(scalarField& increment, const scalarField& source)
{
    if (coefficientsAreOld()) {
        assemble();
    }
    const double norm = 2 * gSumMag(source);
    if (norm == 0) {
        increment = 0;
        return;
    }
    solveOnce(increment, source, min(numerics_.tolerance * norm_ / norm, loosestIncrement));
}

}  // namespace him
