// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    chargingParameters

Description
    Gamma and kappa_c from charging measurements: Rasera et al. 2022,
    Eqs. 17 to 26 and the flowchart of their Fig. 3, with intervals, and the
    size law through several sizes.

Usage
    chargingParameters [-case DIR] [-dict FILE] [-output DIR]

    Reads system/chargingParametersDict. See solver/doc/chargingParameters.md
    for its entries. Everything that is wrong is listed at once; the exit
    code is then 1.

SourceFiles
    chargingParameters.C
    measurementEntries.C
    parameterTable.C
    sizeLawEntries.C
\*---------------------------------------------------------------------------*/
#include "chargingParameters/parameterTable.H"
#include "parallel/session.H"

#include "OSspecific.H"
#include "argList.H"

#include <fstream>

namespace him {

namespace {

parameterReport readDictionary(const Foam::argList& args, Complaints& complaints)
{
    const Foam::fileName casePath = args.rootPath() / args.globalCaseName();
    const Foam::fileName file = args.lookupOrDefault<Foam::fileName>("dict", "system/chargingParametersDict");
    checkedDictionary dictionary(file.isAbsolute() ? file.path() : casePath,
                                 file.isAbsolute() ? Foam::fileName(file.name()) : file, complaints);
    parameterReport report;
    report.measurements = readMeasurements(dictionary, complaints);
    report.request = readSizeLaw(dictionary, report.measurements);
    if (dictionary.readable() && !dictionary.has("measurements") && !dictionary.has("sizeLaw")) {
        complaints.add(file, "there is neither a section measurements nor a section sizeLaw in it.");
    }
    dictionary.refuseUnknownEntries();
    return report;
}

/// The averages have no fault, but some corner of the intervals may be impossible.
void solve(parameterReport& report, const std::string& where, Complaints& complaints)
{
    for (const namedMeasurement& m : report.measurements) {
        try {
            report.parameters.push_back(parametersOf(m.measured));
        } catch (const std::invalid_argument& impossible) {
            report.parameters.emplace_back();
            const bool readings = !m.measured.historyCharges.empty();
            complaints.add(where + ": measurements: " + m.name, (readings ? "" : "within the intervals of the inputs: ")
                                                                    + std::string(impossible.what()) + ".");
        }
    }
    if (report.request && complaints.none()) {
        report.sizeLaw = solveSizeLaw(*report.request, report.measurements, report.parameters);
    }
}

void write(const Foam::fileName& file, const std::string& text)
{
    std::ofstream stream(file);
    stream << text;
    stream.close();
    if (!stream) {
        throw std::runtime_error("the file " + file + " cannot be written. Give another folder with -output.");
    }
}

void run(const Foam::argList& args, MPI_Comm communicator)
{
    Complaints complaints;
    parameterReport report = readDictionary(args, complaints);
    stopOnComplaints(complaints, "Dictionary", communicator);
    solve(report, args.lookupOrDefault<Foam::fileName>("dict", "system/chargingParametersDict"), complaints);
    stopOnComplaints(complaints, "Measurements", communicator);

    const std::string entries = entriesText(report);
    Foam::Info << '\n' << logText(report).c_str() << entries.c_str();
    const Foam::fileName standard = args.rootPath() / args.globalCaseName() / "postProcessing" / "chargingParameters";
    const Foam::fileName folder = args.lookupOrDefault<Foam::fileName>("output", standard);
    Foam::mkDir(folder);
    write(folder / "parameters.csv", csvText(report));
    write(folder / "entries.liggghts", entries);
    Foam::Info << "\nwritten to " << folder << ": parameters.csv, entries.liggghts\n\nEnd\n" << Foam::endl;
}

}  // namespace

}  // namespace him

int main(int argc, char* argv[])
{
    Foam::argList::addNote("Gamma and kappa_c from charging measurements, by the flowchart of Rasera et al. 2022.");
    Foam::argList::addOption("dict", "file", "Dictionary in place of system/chargingParametersDict");
    Foam::argList::addOption("output", "folder", "In place of postProcessing/chargingParameters");
    Foam::argList::noParallel();
    Foam::argList::noFunctionObjects();
    return him::runSession(argc, argv, him::run);
}
