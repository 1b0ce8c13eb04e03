// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"

#include "foamPoissonMesh/meshArrays.H"
#include "insulatingWalls/wallCharges.H"
#include "settings/checkedDictionary.H"
#include "settings/electricRegion.H"
#include "settings/foamExceptions.H"

#include "IStringStream.H"
#include "OSspecific.H"
#include "coupledPolyPatch.H"
#include "emptyPolyPatch.H"
#include "fvSchemes.H"
#include "gradScheme.H"
#include "wedgePolyPatch.H"

namespace him {

namespace {

/// Units of the electric potential, V = kg m2 s-3 A-1.
const Foam::dimensionSet volt(1, 2, -3, 0, 0, -1, 0);

/// Allowed shortfall of the cutoff against the cell diagonal, for round-off in the mesh points.
constexpr double diagonalTolerance = 1e-9;

bool onAllRanks(bool holds)
{
    return Foam::returnReduce(holds, Foam::andOp<bool>());
}

bool onAnyRank(bool holds)
{
    return Foam::returnReduce(holds, Foam::orOp<bool>());
}

/// constant/polyMesh, or the same of a region.
std::string meshFolder(const Foam::polyMesh& mesh)
{
    return ofRegion("constant", mesh.name()) / Foam::polyMesh::meshSubDir;
}

void refuseFlatMesh(const Foam::polyMesh& mesh, Complaints& complaints)
{
    for (const Foam::polyPatch& patch : mesh.boundaryMesh()) {
        if (Foam::isA<Foam::emptyPolyPatch>(patch) || Foam::isA<Foam::wedgePolyPatch>(patch)) {
            complaints.add(
                meshFolder(mesh) + "/boundary: " + patch.name(),
                "found a patch of type " + patch.type()
                    + ". Charges are points in three dimensions, and a mesh "
                      "of one cell depth cannot hold their field. Use a mesh with all three directions; walls or "
                      "cyclic patches may stand in for the missing ones.");
        }
    }
}

/// Numerics that the files name but OpenFOAM does not know.
void checkSchemes(const Foam::fvMesh& mesh, const potentialNumerics& numerics, Complaints& complaints)
{
    attempt(std::string(ofRegion("system", mesh.name()) / "fvSchemes") + ": gradSchemes", complaints, [&] {
        Foam::IStringStream scheme(numerics.gradient);
        Foam::fv::gradScheme<Foam::scalar>::New(mesh, scheme);
    });
}

}  // namespace

bool cutForThisRun(const Foam::Time& runTime, Complaints& complaints)
{
    int parts = 0;
    while (Foam::isDir(runTime.globalPath() / ("processor" + std::to_string(parts)))) {
        ++parts;
    }
    Foam::Pstream::scatter(parts);
    const int ranks = Foam::Pstream::nProcs();
    if (Foam::Pstream::parRun() && parts > 0 && parts != ranks) {
        complaints.add("processor folders", "the mesh is cut into " + std::to_string(parts) + " parts, but the run has "
                                                + std::to_string(ranks)
                                                + " ranks. Run decomposePar for this number of ranks.");
        return false;
    }
    return true;
}

void checkControlDict(const Foam::fileName& casePath, Complaints& complaints)
{
    checkedDictionary control(casePath, "system/controlDict", complaints);
    control.oneOf("writeControl",
                  {"timeStep", "runTime", "adjustable", "adjustableRunTime", "clockTime", "cpuTime", "none"},
                  "timeStep");
    if (control.yesNo("adjustTimeStep", false)) {
        control.complain("adjustTimeStep",
                         "himFoam reads it, maxCo and maxDeltaT in constant/gasProperties. Write them there.");
    }
    control.positive("deltaT");
    control.number("endTime");
    control.positive("writeInterval");
}

Foam::autoPtr<Foam::fvMesh> openMesh(const Foam::Time& runTime, Complaints& complaints)
{
    if (!cutForThisRun(runTime, complaints)) {
        return nullptr;
    }
    bool complete = true;
    const Foam::word region = electricRegion(runTime.globalPath());
    const std::string where = ofRegion("constant", region) / Foam::polyMesh::meshSubDir;
    const Foam::fileName folder = runTime.path() / where;
    const Foam::fileName system = ofRegion("system", region);
    const std::string cutting =
        region == Foam::polyMesh::defaultRegion ? "decomposePar" : "decomposePar -region " + region;
    if (!onAllRanks(Foam::isFile(folder / "owner"))) {
        complaints.add(where, "there is no mesh in " + folder
                                  + ", but the field method needs one. Make it with blockMesh, and cut it with "
                                  + cutting + " for a parallel run.");
        complete = false;
    }
    const std::size_t before = complaints.lines().size();
    readPotentialNumerics(runTime.globalPath(), system, complaints);
    complete = complete && complaints.lines().size() == before;
    if (!complete) {
        return nullptr;
    }

    // A mesh reads schemes and solution together or not at all.
    const bool haveNumerics = checkedDictionary::exists(runTime.globalPath(), system / "fvSchemes")
                              && checkedDictionary::exists(runTime.globalPath(), system / "fvSolution");
    Foam::autoPtr<Foam::fvMesh> mesh;
    attempt(where, complaints, [&] {
        mesh.reset(new Foam::fvMesh(Foam::IOobject(
            region, runTime.timeName(), runTime, haveNumerics ? Foam::IOobject::MUST_READ : Foam::IOobject::NO_READ)));
    });
    return onAllRanks(mesh.valid()) ? std::move(mesh) : nullptr;
}

std::unique_ptr<foamPoissonMesh> openPoissonMesh(const Foam::fvMesh& mesh, double permittivity, Complaints& complaints,
                                                 bool neutralisingBackground, const dielectricChoices& dielectrics,
                                                 double accuracy)
{
    const std::size_t before = complaints.lines().size();
    refuseFlatMesh(mesh, complaints);
    Complaints alreadyMade;  // by openMesh
    potentialNumerics numerics =
        readPotentialNumerics(mesh.time().globalPath(), ofRegion("system", mesh.name()), alreadyMade);
    if (accuracy > 0 && !numerics.toleranceGiven) {
        numerics.tolerance = toleranceFor(accuracy);
    }
    checkSchemes(mesh, numerics, complaints);

    const std::string where = ofRegion(mesh.time().timeName(), mesh.name()) / "electricPotential";
    Foam::IOobject header("electricPotential", mesh.time().timeName(), mesh, Foam::IOobject::MUST_READ);
    if (!onAllRanks(header.typeHeaderOk<Foam::volScalarField>(true))) {
        complaints.add(
            where, "there is no such field (volScalarField) at the start time. It gives the voltage of every patch.");
    }
    if (onAnyRank(complaints.lines().size() > before)) {
        return nullptr;
    }

    std::unique_ptr<foamPoissonMesh> poisson;
    attempt(where, complaints,
            [&] { poisson = std::make_unique<foamPoissonMesh>(mesh, permittivity, numerics, neutralisingBackground); });
    if (!onAllRanks(bool(poisson))) {
        return nullptr;
    }
    if (poisson->electricPotential().dimensions() != volt) {
        complaints.add(where + ": dimensions", "found other units than volt. Write dimensions [1 2 -3 0 0 -1 0];");
    }
    attempt("electrostaticProperties", complaints, [&] { poisson->setDielectrics(dielectrics, complaints); });
    if (poisson->matter() && numerics.gradient.rfind("Gauss linear", 0) != 0) {
        complaints.add(std::string(ofRegion("system", mesh.name()) / "fvSchemes") + ": gradSchemes",
                       "found `" + numerics.gradient
                           + "`, but with insulating walls or zones of other permittivity the gradient "
                             "is made of the potentials of the faces: write Gauss linear.");
    }
    return poisson;
}

void checkConditions(const FieldSettings& settings, const foamPoissonMesh& mesh, Complaints& complaints)
{
    if (settings.method != "p3m") {
        refuseCouplings(mesh.electricPotential(), complaints);
    } else {
        refuseConditionsUnknownToP3m(mesh.electricPotential(), complaints);
        if (mesh.matter() && !mesh.matter()->uniform()) {
            complaints.add(
                "constant/electrostaticProperties: zonePermittivity",
                "p3m knows one permittivity, that of the gas, in all cells. Leave zonePermittivity out (charge on "
                "insulating walls works all the same), or use fieldMethod him or himCell.");
        }
    }
}

void checkCutoff(const FieldSettings& settings, const foamPoissonMesh& mesh, Complaints& complaints)
{
    const double diagonal = mesh.largestCellDiagonal();
    const bool read = settings.nearCutoff > 0;
    if (read && FieldMethod::needsCutoff(settings.method) && settings.nearCutoff < diagonal * (1 - diagonalTolerance)) {
        complaints.add("constant/electrostaticProperties: " + settings.method + "Coeffs: nearCutoff",
                       shown(settings.nearCutoff) + " m is below the largest cell diagonal, " + shown(diagonal)
                           + " m. Pairs inside one cell would be missed. Use at least " + shown(diagonal)
                           + ", or refine the mesh.");
    }
}

void checkWallTargets(const caseSettings& settings, const foamPoissonMesh* mesh, Complaints& complaints)
{
    const std::string where = "constant/couplingProperties: walls: ";
    for (const auto& [wall, target] : settings.walls) {
        if (target == noTransfer) {
            continue;
        }
        if (!mesh) {
            if (target == insulatingTarget) {
                complaints.add(where + wall,
                               "an insulating wall needs faces of a mesh to carry its charge, and fieldMethod "
                                   + settings.field.method
                                   + " reads none. Use him, himCell or p3m, or map the wall to grounded.");
            } else if (target != groundedTarget) {
                complaints.add(where + wall, "unknown target `" + target + "`; fieldMethod " + settings.field.method
                                                 + " reads no mesh, so the known ones are grounded, noTransfer.");
            }
            continue;
        }
        if (wallCharges::isInsulating(target, mesh->matter())) {
            continue;
        }
        if (!mesh->matter() && settings.dielectrics.any()) {
            continue;  // the walls could not be made, for reasons that have been said
        }
        if (target == insulatingTarget) {
            complaints.add(where + wall,
                           "an insulating wall needs faces of the mesh to carry its charge, and the case names none. "
                           "Name internal faces in insulatingWalls of constant/electrostaticProperties, or give a "
                           "patch the condition insulatingWall in electricPotential.");
            continue;
        }
        std::vector<std::string> known;
        for (const Foam::polyPatch& patch : mesh->mesh().boundaryMesh()) {
            if (!Foam::isA<Foam::coupledPolyPatch>(patch)) {
                known.push_back(patch.name());
            }
        }
        const Foam::label patch = mesh->mesh().boundaryMesh().findPatchID(target);
        if (patch < 0 || mesh->electricPotential().boundaryField()[patch].coupled()) {
            const std::vector<std::string> insulating =
                mesh->matter() ? mesh->matter()->wallNames() : std::vector<std::string>();
            complaints.add(
                where + wall,
                "unknown target `" + target + "`; known: the patches " + joined(known)
                    + (insulating.empty() ? "" : ", the insulating walls " + joined(insulating) + " (or insulating)")
                    + ", and noTransfer.");
        } else if (!mesh->electricPotential().boundaryField()[patch].fixesValue()) {
            const std::string type = mesh->electricPotential().boundaryField()[patch].type();
            complaints.add(
                where + wall,
                "the potential on patch " + target + " is " + type
                    + ", which does not fix a voltage. "
                      "Give the patch a fixedValue in electricPotential, or the condition insulatingWall where it "
                      "keeps its charge, or map the wall to noTransfer.");
        }
    }
}

}  // namespace him
