// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/gasNumericsChecks.H"

#include "settings/checkedDictionary.H"
#include "settings/foamExceptions.H"

#include "OSspecific.H"
#include "convectionScheme.H"
#include "gradScheme.H"
#include "laplacianScheme.H"
#include "lduMatrix.H"
#include "snGradScheme.H"
#include "surfaceInterpolationScheme.H"
#include "volFields.H"

namespace him {

void checkTimeSchemes(const Foam::fvMesh& mesh, Complaints& complaints)
{
    const std::string where = "system/fvSchemes: ddtSchemes";
    bool said = false;
    for (const char* name : {"ddt(voidFraction,U)", "ddt(voidFraction)", "ddt(U)"}) {
        Foam::word scheme = "Euler";
        said = said || !attempt(where, complaints, [&] {
                   Foam::ITstream words(mesh.ddtScheme(name));
                   scheme = Foam::word(words);
               });
        if (scheme != "Euler" && !said) {
            complaints.add(where, "found " + scheme + ", but the gas takes Euler only. Write default Euler;");
            said = true;
        }
    }
}

void checkGasNumerics(const Foam::fvMesh& mesh, const Foam::surfaceScalarField& flux, Complaints& complaints)
{
    using namespace Foam;
    const std::string schemes = "system/fvSchemes: ";
    attempt(schemes + "divSchemes: div(alphaPhi,U)", complaints,
            [&] { fv::convectionScheme<vector>::New(mesh, flux, mesh.divScheme("div(alphaPhi,U)")); });
    attempt(schemes + "divSchemes", complaints, [&] { mesh.divScheme("div(alphaNu*dev2(T(grad(U))))"); });
    attempt(schemes + "gradSchemes", complaints,
            [&] { fv::gradScheme<vector>::New(mesh, mesh.gradScheme("grad(U)")); });
    attempt(schemes + "snGradSchemes", complaints,
            [&] { fv::snGradScheme<scalar>::New(mesh, mesh.snGradScheme("snGrad(p)")); });
    for (const char* name : {"interpolate(drag)", "interpolate(A)", "interpolate(voidFraction)"}) {
        attempt(schemes + "interpolationSchemes", complaints,
                [&] { surfaceInterpolationScheme<scalar>::New(mesh, mesh.interpolationScheme(name)); });
    }
    attempt(schemes + "laplacianSchemes: laplacian(alphaNu,U)", complaints,
            [&] { fv::laplacianScheme<vector, scalar>::New(mesh, mesh.laplacianScheme("laplacian(alphaNu,U)")); });
    attempt(schemes + "laplacianSchemes: laplacian(rAf,p)", complaints,
            [&] { fv::laplacianScheme<scalar, scalar>::New(mesh, mesh.laplacianScheme("laplacian(rAf,p)")); });
    for (const char* name : {"p", "pFinal"}) {
        const std::string where = std::string("system/fvSolution: solvers: ") + name;
        attempt(where, complaints, [&] {
            const word solver(mesh.solverDict(name).lookup("solver"));
            if (!lduMatrix::solver::symMatrixConstructorTablePtr_->found(solver)) {
                const wordList known = lduMatrix::solver::symMatrixConstructorTablePtr_->sortedToc();
                complaints.add(where, "unknown solver `" + solver + "`; known: "
                                          + joined(std::vector<std::string>(known.begin(), known.end())) + ".");
            }
        });
    }
    if (!mesh.solutionDict().subOrEmptyDict("relaxationFactors").empty()) {
        complaints.add("system/fvSolution: relaxationFactors", "the gas is not relaxed. Remove the section.");
    }
    for (const char* folder : {"constant", "system"}) {
        if (isFile(mesh.time().globalPath() / folder / "fvOptions")) {
            complaints.add(std::string(folder) + "/fvOptions", "the gas has no such sources. Remove the file.");
        }
    }
}

}  // namespace him
