// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    poissonBenchmark

Description
    Seconds and field error of Poisson's equation for several linear solvers
    and tolerances on the mesh of a case, whose conditions and schemes it
    uses: cold (from zero), and warm after 2 % of the charges have moved one
    cell. The field error is measured against a solve to 1e-12. The table in
    solver/doc/poisson.md comes from here.

Usage
    poissonBenchmark [-case DIR]
\*---------------------------------------------------------------------------*/
#include "checks/caseChecks.H"
#include "directSolve/directSolver.H"
#include "foamPoissonMesh/meshArrays.H"
#include "foamPoissonMesh/potentialEquation.H"
#include "parallel/session.H"

#include "IStringStream.H"
#include "argList.H"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <random>
#include <vector>

namespace {

using namespace him;

constexpr int moves = 5;

double cpuSeconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// One charge of +1 or -1 in a tenth of the cells; laplacian(V) integrated over the cells is minus that.
Foam::scalarField randomCharges(const Foam::fvMesh& mesh, std::mt19937& dice)
{
    Foam::scalarField source(mesh.nCells(), Foam::Zero);
    std::uniform_int_distribution<Foam::label> cell(0, mesh.nCells() - 1);
    for (Foam::label i = 0; i < mesh.nCells() / 10; ++i) {
        source[cell(dice)] += i % 2 ? 1 : -1;
    }
    return source;
}

/// Moves 2 % of the charges to a neighbouring cell.
void moveCharges(const Foam::fvMesh& mesh, std::mt19937& dice, Foam::scalarField& source)
{
    std::uniform_real_distribution<double> chance(0, 1);
    for (Foam::label cell = 0; cell < mesh.nCells(); ++cell) {
        if (source[cell] != 0 && chance(dice) < 0.02) {
            const Foam::labelList& neighbours = mesh.cellCells()[cell];
            const Foam::label other = neighbours[static_cast<Foam::label>(chance(dice) * neighbours.size())];
            source[other] += source[cell];
            source[cell] = 0;
        }
    }
}

double relativeError(const Foam::vectorField& field, const Foam::vectorField& exact)
{
    return std::sqrt(Foam::gSum(Foam::magSqr(Foam::vectorField(field - exact))()) / Foam::gSum(Foam::magSqr(exact)()));
}

struct Solver {
    const char* name;
    const char* controls;
};

void measure(Foam::volScalarField& potential, potentialNumerics numerics, const Solver& solver, double tolerance,
             const std::vector<Foam::scalarField>& sources, const std::vector<Foam::vectorField>& exact)
{
    numerics.solver = Foam::dictionary(Foam::IStringStream(solver.controls)());
    numerics.tolerance = tolerance;
    potential == Foam::dimensionedScalar(potential.dimensions(), Foam::Zero);
    potentialEquation equation(potential, numerics);
    const double perCell = 1e9 / static_cast<double>(potential.mesh().nCells());
    double start = cpuSeconds();
    equation.solve(sources[0]);
    const double first = (cpuSeconds() - start) * perCell;
    potential == Foam::dimensionedScalar(potential.dimensions(), Foam::Zero);
    start = cpuSeconds();
    equation.solve(sources[0]);
    const double cold = (cpuSeconds() - start) * perCell;
    const double coldError = relativeError(Foam::vectorField(-equation.gradient()().primitiveField()), exact[0]);
    std::vector<double> warm;
    double warmError = 0;
    for (std::size_t n = 1; n < sources.size(); ++n) {
        start = cpuSeconds();
        equation.solve(sources[n]);
        warm.push_back((cpuSeconds() - start) * perCell);
        warmError = std::max(warmError, relativeError(Foam::vectorField(-equation.gradient()().primitiveField()), exact[n]));
    }
    std::sort(warm.begin(), warm.end());
    std::printf("| %s | %g | %.0f | %.0f | %.0f | %.1e | %.1e |\n", solver.name, tolerance, first, cold,
                warm[warm.size() / 2], coldError, warmError);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char* argv[])
{
    Foam::argList args(argc, argv, true, true);
    const MPI_Comm communicator = openSession("poissonBenchmark");
    Complaints complaints;
    Foam::Time runTime(Foam::Time::controlDictName, args);
    Foam::autoPtr<Foam::fvMesh> mesh = openMesh(runTime, complaints);
    const potentialNumerics numerics = readPotentialNumerics(runTime.globalPath(), "system", complaints);
    stopOnComplaints(complaints, "Mesh", communicator);
    Foam::solverPerformance::debug = 0;
    Foam::volScalarField potential(
        Foam::IOobject("electricPotential", runTime.timeName(), mesh(), Foam::IOobject::MUST_READ), mesh());

    std::mt19937 dice(1);
    std::vector<Foam::scalarField> sources{randomCharges(mesh(), dice)};
    for (int move = 0; move < moves; ++move) {
        sources.push_back(sources.back());
        moveCharges(mesh(), dice, sources.back());
    }
    std::vector<Foam::vectorField> exact;
    {
        potentialNumerics tight = numerics;
        tight.tolerance = 1e-12;
        tight.solver = Foam::dictionary(Foam::IStringStream("solver GAMG; smoother GaussSeidel; relTol 0;")());
        potentialEquation equation(potential, tight);
        for (const Foam::scalarField& source : sources) {
            equation.solve(source);
            exact.push_back(Foam::vectorField(-equation.gradient()().primitiveField()));
        }
    }
    const std::vector<Solver> solvers{
        {"GAMG GaussSeidel", "solver GAMG; smoother GaussSeidel; relTol 0;"},
        {"GAMG symGaussSeidel", "solver GAMG; smoother symGaussSeidel; nPostSweeps 1; nFinestSweeps 1; relTol 0;"},
        {"GAMG DICGaussSeidel", "solver GAMG; smoother DICGaussSeidel; relTol 0;"},
        {"GAMG DIC", "solver GAMG; smoother DIC; relTol 0;"},
        {"PCG DIC", "solver PCG; preconditioner DIC; relTol 0; maxIter 5000;"},
        {"PCG GAMG", "solver PCG; preconditioner { preconditioner GAMG; smoother GaussSeidel; tolerance 1e-6; relTol 0; "
                     "nVcycles 1; } relTol 0;"}};
    if (const auto direct = directSolver::create(makeMeshArrays(potential), communicator)) {
        Scalars source(mesh().nCells());
        std::copy(sources[0].begin(), sources[0].end(), source.begin());
        Scalars values;
        std::vector<double> seconds;
        for (int n = 0; n < 9; ++n) {
            const double start = cpuSeconds();
            direct->solve(-source, directSolver::Operator::finiteVolume, values);
            seconds.push_back(cpuSeconds() - start);
        }
        std::sort(seconds.begin(), seconds.end());
        std::printf("direct solve: %.1f ns per cell (median), %.1f (least)\n", 1e9 * seconds[4] / mesh().nCells(),
                    1e9 * seconds[0] / mesh().nCells());
    }
    std::printf("%d cells, ns per cell and solve, CPU time of one core\n", mesh().nCells());
    std::printf("| solver | tolerance | first (with assembly) | cold | warm | field error cold | warm |\n");
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6}) {
        for (const Solver& solver : solvers) {
            measure(potential, numerics, solver, tolerance, sources, exact);
        }
    }
    return 0;
}
