// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    wallProbe

Description
    Charges the insulating walls and the zones of a case as
    constant/probeProperties says, solves, and says what came out, one
    "name value" a line:

        <wall>.potential, <wall>.least, <wall>.most   V_f of the wall [V]
        <patch>.flux    integral of eps E . n over a patch, n out of the mesh [C]
        <zone>.flux     the same over all faces around a cell zone, n out of it, at walls on the zone's own side [C]
        charge          all there is [C]

    Fields and wallSurfaceCharge are written to the start time.

        surfaceCharge { wall 1e-6; }    // [C/m2], walls not named: 0
        chargeDensity { zone 1e-3; }    // [C/m3]

Usage
    wallProbe [-case DIR] [-parallel]
\*---------------------------------------------------------------------------*/
#include "checks/caseChecks.H"
#include "parallel/session.H"

#include "argList.H"

#include <cstdio>

namespace {

using namespace him;

void say(const std::string& name, double value)
{
    if (Foam::Pstream::master()) {
        std::printf("%s %.17g\n", name.c_str(), value);
    }
}

double sum(double value)
{
    return Foam::returnReduce(Foam::scalar(value), Foam::sumOp<Foam::scalar>());
}

void chargeWalls(dielectrics& matter, const Foam::dictionary& perArea)
{
    Scalars charge = Scalars::Zero(matter.ownedFaces());
    for (Foam::label face = 0; face < matter.ownedFaces(); ++face) {
        const std::string& name = matter.wallNames()[static_cast<std::size_t>(matter.wallOf(face))];
        charge[face] = matter.areaOf(face) * (perArea.getOrDefault<Foam::scalar>(name, 0) - matter.surfaceCharge(face));
    }
    matter.addCharge(charge);
}

Scalars chargesOfZones(const Foam::fvMesh& mesh, const Foam::dictionary& densities)
{
    Scalars charge = Scalars::Zero(mesh.nCells());
    for (const Foam::word& zone : densities.toc()) {
        for (const Foam::label cell : mesh.cellZones()[zone]) {
            charge[cell] = densities.get<Foam::scalar>(zone) * mesh.V()[cell];
        }
    }
    return charge;
}

void sayWalls(const dielectrics& matter, const Foam::volScalarField& potential)
{
    const Foam::surfaceScalarField values(matter.faceValues(potential));
    for (std::size_t wall = 0; wall < matter.wallNames().size(); ++wall) {
        Foam::scalar area = 0, mean = 0, least = Foam::VGREAT, most = -Foam::VGREAT;
        for (Foam::label face = 0; face < matter.ownedFaces(); ++face) {
            if (matter.wallOf(face) != static_cast<int>(wall)) {
                continue;
            }
            const double value = matter.faceValue(face, values);
            area += matter.areaOf(face);
            mean += matter.areaOf(face) * value;
            least = Foam::min(least, value);
            most = Foam::max(most, value);
        }
        say(matter.wallNames()[wall] + ".potential", sum(mean) / sum(area));
        say(matter.wallNames()[wall] + ".least", Foam::returnReduce(least, Foam::minOp<Foam::scalar>()));
        say(matter.wallNames()[wall] + ".most", Foam::returnReduce(most, Foam::maxOp<Foam::scalar>()));
    }
}

void sayFluxes(const dielectrics& matter, const Foam::volScalarField& potential, double permittivity)
{
    for (const Foam::fvPatchScalarField& patch : potential.boundaryField()) {
        if (!patch.coupled()) {
            const Foam::scalarField& ratio = matter.ratio().boundaryField()[patch.patch().index()];
            say(patch.patch().name() + ".flux",
                -permittivity * sum(Foam::sum(ratio * patch.snGrad() * patch.patch().magSf())));
        }
    }
}

/// Whether cells lie in a zone, one number each, known across ranks.
Foam::volScalarField membersOf(const Foam::cellZone& zone, const Foam::fvMesh& mesh)
{
    Foam::volScalarField members(Foam::IOobject("members", mesh.time().timeName(), mesh), mesh,
                                 Foam::dimensionedScalar("members", Foam::dimless, 0), "zeroGradient");
    for (const Foam::label cell : zone) {
        members[cell] = 1;
    }
    members.correctBoundaryConditions();
    return members;
}

double permittivityOf(const Foam::cellZone& zone, const caseSettings& settings)
{
    for (const auto& [name, relative] : settings.dielectrics.permittivity) {
        if (name == zone.name()) {
            return settings.field.permittivity * relative / settings.dielectrics.gas;
        }
    }
    return settings.field.permittivity;
}

/// Integral of E . n over the faces around a zone [V m], with the potentials V_f of the faces as the cells of the zone see them.
double fluxOutOf(const Foam::cellZone& zone, const dielectrics& matter, const Foam::volScalarField& potential)
{
    const Foam::fvMesh& mesh = potential.mesh();
    const Foam::volScalarField members(membersOf(zone, mesh));
    const Foam::surfaceScalarField values(matter.faceValues(potential));
    const auto out = [&](Foam::label cell, const Foam::vector& centre, const Foam::vector& area, double value) {
        const double distance = Foam::mag((centre - mesh.C()[cell]) & area) / Foam::mag(area);
        return (potential[cell] - value) / distance * Foam::mag(area);
    };
    double flux = 0;
    for (Foam::label face = 0; face < mesh.nInternalFaces(); ++face) {
        for (const auto& [cell, other] : {std::pair(mesh.owner()[face], mesh.neighbour()[face]),
                                          std::pair(mesh.neighbour()[face], mesh.owner()[face])}) {
            if (members[cell] > members[other]) {
                flux += out(cell, mesh.Cf()[face], mesh.Sf()[face], values[face]);
            }
        }
    }
    for (const Foam::fvPatch& patch : mesh.boundary()) {
        const Foam::scalarField across(patch.coupled() ? members.boundaryField()[patch.index()].patchNeighbourField()()
                                                       : Foam::scalarField(patch.size(), 0));
        for (Foam::label face = 0; face < patch.size(); ++face) {
            const Foam::label cell = patch.faceCells()[face];
            if (members[cell] > across[face]) {
                flux += out(cell, patch.Cf()[face], patch.Sf()[face], values.boundaryField()[patch.index()][face]);
            }
        }
    }
    return sum(flux);
}

}  // namespace

int main(int argc, char* argv[])
{
    Foam::argList::noCheckProcessorDirectories();
    Foam::argList args(argc, argv);
    const MPI_Comm communicator = him::openSession("wallProbe");
    him::Complaints complaints;
    const Foam::fileName casePath = args.rootPath() / args.globalCaseName();
    const him::caseSettings settings = him::readCaseSettings(casePath, complaints);
    him::checkedDictionary properties(casePath, "constant/probeProperties", complaints);
    Foam::Time runTime(Foam::Time::controlDictName, args);
    Foam::autoPtr<Foam::fvMesh> mesh = him::openMesh(runTime, complaints);
    him::stopOnComplaints(complaints, "Probe", communicator);
    const auto poisson =
        him::openPoissonMesh(mesh(), settings.field.permittivity, complaints, false, settings.dielectrics);
    him::stopOnComplaints(complaints, "Probe", communicator);
    him::dielectrics& matter = *poisson->matter();

    chargeWalls(matter, properties.contents().subOrEmptyDict("surfaceCharge"));
    const him::Scalars charge = chargesOfZones(mesh(), properties.contents().subOrEmptyDict("chargeDensity"));
    poisson->solve(charge);
    double all = sum(charge.sum());
    for (const double onWall : matter.totals()) {
        all += onWall;
    }
    say("charge", all);
    sayWalls(matter, poisson->electricPotential());
    sayFluxes(matter, poisson->electricPotential(), settings.field.permittivity);
    for (const Foam::cellZone& zone : mesh().cellZones()) {
        say(zone.name() + ".flux",
            permittivityOf(zone, settings) * fluxOutOf(zone, matter, poisson->electricPotential()));
    }
    poisson->electricPotential().write();
    mesh().lookupObject<Foam::volVectorField>("electricField").write();
    matter.write();
    return 0;
}
