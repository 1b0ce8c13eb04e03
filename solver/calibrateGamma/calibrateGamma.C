// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    calibrateGamma

Description
    Gamma for a wanted charge per mass, interpolated between preliminary runs
    (Sippola et al. 2018, section 4.3).

Usage
    calibrateGamma -runs FILE -target Q | "(Q ...)"

    FILE has one line per run, # starts a comment:

        <Gamma [V/m]> <saturated charge per mass [C/kg]>
        <Gamma [V/m]> <charge.dat> [<charge.dat> ...] <mass [kg]>

    See solver/doc/calibrate_gamma.md. Everything that is wrong is listed at
    once; the exit code is then 1.

SourceFiles
    calibrateGamma.C
    calibrationRuns.C
\*---------------------------------------------------------------------------*/
#include "calibrateGamma/calibrationRuns.H"
#include "dem_coupling/gamma_calibration.hpp"
#include "parallel/session.H"

#include "IStringStream.H"
#include "argList.H"

#include <cmath>
#include <optional>

namespace him {

namespace {

/// A number, or a list of numbers [C/kg].
std::vector<double> readTargets(const Foam::argList& args, Complaints& complaints)
{
    const std::string words = args.lookupOrDefault<Foam::string>("target", "");
    std::istringstream text(
        words.size() > 1 && words.front() == '(' && words.back() == ')' ? words.substr(1, words.size() - 2) : words);
    std::vector<double> targets;
    std::string word;
    while (text >> word) {
        const std::optional<double> target = finiteNumber(word);
        if (!target) {
            complaints.add("-target", "found " + word + ", which is no number [C/kg].");
        } else {
            targets.push_back(*target);
        }
    }
    if (targets.empty() && complaints.none()) {
        complaints.add("-target", "expected a charge per mass [C/kg], or several: -target \"(5e-5 8e-5)\".");
    }
    return targets;
}

void run(const Foam::argList& args, MPI_Comm communicator)
{
    Complaints complaints;
    const std::vector<double> targets = readTargets(args, complaints);
    std::optional<GammaCalibration> calibration;
    if (!args.found("runs")) {
        complaints.add("-runs", "expected a file with one line per run, see solver/doc/calibrate_gamma.md.");
    } else {
        const Foam::fileName file = args.get<Foam::fileName>("runs");
        const std::size_t before = complaints.lines().size();
        const std::vector<CalibrationRun> runs = readCalibrationRuns(file, complaints);
        if (complaints.lines().size() == before) {
            try {
                calibration.emplace(runs);
            } catch (const std::invalid_argument& impossible) {
                complaints.add(file, std::string(impossible.what()) + ".");
            }
        }
    }
    stopOnComplaints(complaints, "Calibration", communicator);

    std::ostringstream text;
    text.precision(8);
    text << "# charge per mass [C/kg]   Gamma [V/m]\n";
    for (const CalibrationRun& one : calibration->runs()) {
        text << "# run: " << one.chargePerMass << ' ' << one.gamma << '\n';
    }
    for (const double target : targets) {
        const GammaCalibration::Found found = calibration->gammaFor(target);
        text << target << ' ' << found.gamma << (found.inside ? "" : "  # extrapolated beyond the runs") << '\n';
    }
    Foam::Info << text.str().c_str() << Foam::endl;
}

}  // namespace

}  // namespace him

int main(int argc, char* argv[])
{
    Foam::argList::addNote("Gamma for a wanted charge per mass, interpolated between preliminary runs.");
    Foam::argList::addOption("runs", "file",
                             "One line per run: Gamma and charge per mass, or Gamma, charge.dat files and mass");
    Foam::argList::addOption("target", "Q | \"(Q ...)\"", "Wanted charge per mass [C/kg]");
    Foam::argList::noBanner();
    Foam::argList::noParallel();
    Foam::argList::noFunctionObjects();
    return him::runSession(argc, argv, him::run);
}
