// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    himField

Description
    Electric field and potential at given charged particles, by any field
    method of himFoam, on the mesh and with the boundary conditions of a case.

Usage
    himField [-case DIR] -particles FILE.csv [-method NAME] [-output FILE.csv]
             [-parallel]

    See solver/doc/himField.md. Neither a DEM script nor couplingProperties is
    needed. Everything that is wrong is listed at once; the exit code is
    then 1.

SourceFiles
    himField.C
    meshWalls.C
    particleShares.C
    particleTable.C
    snapshot.C
    timedMethod.C
\*---------------------------------------------------------------------------*/
#include "himField/particleShares.H"
#include "himField/snapshot.H"
#include "himField/timedMethod.H"
#include "parallel/session.H"

#include "settings/checkedDictionary.H"

#include "OSspecific.H"

#include <cmath>

namespace him {

namespace {

void refuseOutside(const particleTable& table, const particleShares& shares, const snapshot& s, rowComplaints& faults)
{
    const auto written = [](const Vector3& p) {
        return "(" + shown(p.x()) + " " + shown(p.y()) + " " + shown(p.z()) + ")";
    };
    for (const Index row : shares.outside()) {
        if (!table.faulty[static_cast<std::size_t>(row)]) {
            faults.add(table.place(row), "the particle at " + written(table.position.row(row).matrix().transpose())
                                             + " m is in no cell of the mesh, which covers " + written(s.box.lower)
                                             + " to " + written(s.box.upper) + " m. Are the lengths in m?");
        }
    }
}

void printField(const timedMethod& method, const callTimes& times, const particleShares& shares, MPI_Comm communicator)
{
    const ParticleField& result = method.result();
    double sums[2] = {result.field.square().sum(), method.hasPotential() ? result.energy : 0};
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, communicator);
    const auto count = static_cast<double>(shares.total());
    Foam::Info << "    field " << shown(std::sqrt(sums[0] / count)).c_str() << " V/m (root of mean square), energy "
               << (method.hasPotential() ? shown(sums[1]) + " J" : "n/a").c_str() << "\n    "
               << shown(static_cast<double>(result.pairs) / count).c_str() << " near pairs per particle, "
               << shown(times.total, 3).c_str() << " s:";
    for (std::size_t n = 0; n < fieldPhases.size(); ++n) {
        Foam::Info << (n ? ", " : " ") << PhaseTimes::name(fieldPhases[n]) << ' ' << shown(times.phase[n], 3).c_str();
    }
    Foam::Info << Foam::endl;
}

/// One field, written to `output`. Collective.
void writeField(snapshot& s, const fieldChoice& choice, const particleTable& table, const particleShares& shares,
                const std::string& output, MPI_Comm communicator)
{
    Foam::Info << "\nField of " << static_cast<Foam::label>(shares.total()) << " particles by " << choice.name.c_str()
               << Foam::endl;
    timedMethod method(s.complete(choice.settings), s, communicator);
    const callTimes times = method.call(shares.own());
    printField(method, times, shares, communicator);
    const Points field = shares.gathered(method.result().field);
    const Scalars potential = method.hasPotential() ? shares.gathered(method.result().potential) : Scalars();
    if (Foam::Pstream::master()) {
        Foam::mkDir(Foam::fileName(output).path());
        writeParticleTable(output, table, field, potential);
    }
    Foam::Info << "    written to " << output.c_str() << "\n\nEnd\n" << Foam::endl;
}

void run(const Foam::argList& args, MPI_Comm communicator)
{
    Complaints complaints;
    if (!args.found("particles")) {
        complaints.add("-particles", "the option is missing. Give a file with the columns x,y,z,q.");
        stopOnComplaints(complaints, "Command line", communicator);
    }
    const std::string file = args["particles"];
    std::vector<std::string> names;
    if (args.found("method")) {
        names.push_back(args["method"]);
    }
    snapshot s;
    openSnapshot(args, names, false, s, complaints);
    stopOnComplaints(complaints, "Dictionaries, mesh and fields", communicator);
    const fieldChoice selected{s.choices.selected.method, s.choices.selected};
    const fieldChoice& choice = names.empty() ? selected : *s.choices.find(names.front());
    complaints.add(FieldMethod::check(s.complete(choice.settings), s.poisson.get(), s.box, s.periodic));

    rowComplaints faults(file, complaints);
    particleTable table;
    if (Foam::Pstream::master()) {
        table = readParticleTable(file, complaints, faults);
    }
    const particleShares shares(table, s.poisson.get(), communicator);
    if (Foam::Pstream::master()) {
        refuseOutside(table, shares, s, faults);
        faults.close();
    }
    stopOnComplaints(complaints, "Particles", communicator);

    const Foam::fileName standard = s.runTime().globalPath() / "postProcessing" / "himField" / "field.csv";
    writeField(s, choice, table, shares, args.found("output") ? args["output"] : standard, communicator);
}

}  // namespace

}  // namespace him

int main(int argc, char* argv[])
{
    Foam::argList::addNote("Electric field and potential at the particles of a file, by any field method of himFoam.");
    Foam::argList::addOption("particles", "file", "Comma-separated values with the columns x,y,z,q [m, C]");
    Foam::argList::addOption("method", "name", "Method or variant in place of fieldMethod");
    Foam::argList::addOption("output", "file", "The same lines plus Ex,Ey,Ez,V");
    Foam::argList::noCheckProcessorDirectories();
    Foam::argList::noFunctionObjects();
    Foam::argList args(argc, argv);
    if (!args.checkRootCase()) {
        Foam::FatalError.exit();
    }
    const MPI_Comm communicator = him::openSession(args.executable());
    try {
        him::run(args, communicator);
    } catch (const std::exception& failure) {
        him::stopOnFailure(failure.what(), communicator);
    }
    return 0;
}
