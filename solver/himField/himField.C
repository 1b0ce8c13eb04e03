// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    himField

Description
    Electric field and potential at given charged particles, by any field
    method of himFoam, on the mesh and with the boundary conditions of a case;
    and a comparison of all methods, speed against error.

Usage
    himField [-case DIR] -particles FILE.csv [-method NAME] [-output FILE.csv]
             [-compare [-methods "(NAME ...)"] [-repeat N]] [-parallel]

    See solver/doc/himField.md. Neither a DEM script nor couplingProperties is
    needed. Everything that is wrong is listed at once; the exit code is
    then 1.

SourceFiles
    himField.C
    comparison.C
    comparisonReport.C
    comparisonTable.C
    knownSpaces.C
    meshWalls.C
    particleShares.C
    particleTable.C
    referenceField.C
    roundWall.C
    snapshot.C
    timedMethod.C
\*---------------------------------------------------------------------------*/
#include "himField/comparisonReport.H"
#include "himField/particleShares.H"
#include "himField/snapshot.H"
#include "himField/timedMethod.H"
#include "parallel/session.H"

#include "settings/checkedDictionary.H"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

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

/// Options that do not fit together.
void checkOptions(const Foam::argList& args, Complaints& complaints)
{
    if (!args.found("particles")) {
        complaints.add("-particles", "the option is missing. Give a file with the columns x,y,z,q.");
    }
    for (const char* option : {"method", "output"}) {
        if (args.found("compare") && args.found(option)) {
            complaints.add(std::string("-") + option, "the option is for one field, but -compare is there as well.");
        }
    }
    for (const char* option : {"methods", "repeat"}) {
        if (!args.found("compare") && args.found(option)) {
            complaints.add(std::string("-") + option, "the option is for -compare, which is not there.");
        }
    }
    if (args.found("repeat") && args.lookupOrDefault("repeat", 0) < 1) {
        complaints.add("-repeat", "found `" + args["repeat"] + "`, but a whole number from 1 upwards is expected.");
    }
}

/// A pair sum that is to mirror charges must not go without.
void checkImages(const fieldChoice& choice, const snapshot& s, Complaints& complaints)
{
    if (choice.settings.pairwiseSum.images && !s.walls.refusal.empty()) {
        complaints.add(choice.name + ": images",
                       "found `yes`, but " + s.walls.refusal
                           + ". Charges are mirrored where every wall is at 0 V, and all are "
                             "planes of a convex space or one circular cylinder with flat ends. "
                             "Use p3m, or say `images no` for the field without walls.");
    }
}

/// Names in a list like "(him p3m)"; commas are allowed.
std::vector<std::string> namesIn(std::string list)
{
    std::replace_if(
        list.begin(), list.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    std::istringstream stream(list);
    return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

void run(const Foam::argList& args, MPI_Comm communicator)
{
    Complaints complaints;
    checkOptions(args, complaints);
    stopOnComplaints(complaints, "Command line", communicator);
    const bool compare = args.found("compare");
    const char* option = compare ? "methods" : "method";
    const std::vector<std::string> names = args.found(option) ? namesIn(args[option]) : std::vector<std::string>();
    snapshot s;
    openSnapshot(args, names, compare, s, complaints);
    stopOnComplaints(complaints, "Dictionaries, mesh and fields", communicator);
    const fieldChoice selected{s.choices.selected.method, s.choices.selected};
    const fieldChoice& choice = names.empty() ? selected : *s.choices.find(names.front());
    if (!compare) {
        complaints.add(FieldMethod::check(s.complete(choice.settings), s.poisson.get(), s.box, s.periodic));
        checkImages(choice, s, complaints);
    }

    const std::string file = args["particles"];
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

    const Foam::fileName folder = s.runTime().globalPath() / "postProcessing" / "himField";
    if (compare) {
        comparisonOptions options;
        options.names = names;
        options.rounds = args.lookupOrDefault("repeat", options.rounds);
        reportComparison(s, table, shares, options, folder, communicator);
    } else {
        const std::string standard = folder / "field.csv";
        writeField(s, choice, table, shares, args.found("output") ? args["output"] : standard, communicator);
    }
}

}  // namespace

}  // namespace him

int main(int argc, char* argv[])
{
    Foam::argList::addNote("Electric field and potential at the particles of a file, by any field method of himFoam.");
    Foam::argList::addBoolOption("compare", "Run all methods: table and plot of speed against error");
    Foam::argList::addOption("methods", "list", "The methods and variants to compare, \"(him p3m)\"");
    Foam::argList::addOption("repeat", "N", "Rounds of timed calls in a comparison (default 5)");
    Foam::argList::addOption("particles", "file", "Comma-separated values with the columns x,y,z,q [m, C]");
    Foam::argList::addOption("method", "name", "Method or variant in place of fieldMethod");
    Foam::argList::addOption("output", "file", "The same lines plus Ex,Ey,Ez,V");
    Foam::argList::noCheckProcessorDirectories();
    Foam::argList::noFunctionObjects();
    return him::runSession(argc, argv, him::run);
}
