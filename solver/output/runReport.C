// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/runReport.H"

#include "dem_coupling/field_frequency.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iomanip>
#include <sstream>

namespace him {

using Foam::endl;
using Foam::Info;

namespace {

/// The time left is judged from this many field updates.
constexpr std::size_t recentUpdates = 200;

constexpr int phases = static_cast<int>(Phase::count);

std::string formatted(const char* format, double value)
{
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

/// "45 s", "12 min", "3.2 h"
std::string duration(double seconds)
{
    if (seconds < 100) {
        return formatted("%.0f s", seconds);
    }
    return seconds < 6000 ? formatted("%.0f min", seconds / 60) : formatted("%.1f h", seconds / 3600);
}

/// "DEM 61 %, near sum 3 %, ..." of `total` seconds, without what the scene does not have
std::string shares(const std::array<double, phases>& seconds, double total)
{
    std::string text;
    for (int phase = 0; phase < phases; ++phase) {
        if (seconds[static_cast<std::size_t>(phase)] == 0) {
            continue;
        }
        text += (text.empty() ? "" : ", ") + std::string(PhaseTimes::name(static_cast<Phase>(phase)))
                + formatted(" %.0f %%", total > 0 ? 100 * seconds[static_cast<std::size_t>(phase)] / total : 0);
    }
    return text;
}

std::array<double, phases> secondsOf(const PhaseTimes& times)
{
    std::array<double, phases> seconds;
    for (int phase = 0; phase < phases; ++phase) {
        seconds[static_cast<std::size_t>(phase)] = times.seconds(static_cast<Phase>(phase));
    }
    return seconds;
}

/// What contacts and limits did, by line(name, value).
template <class Line> void addContacts(const Line& line, const ContactCounts& contacts)
{
    line("contacts with particles, walls",
         formatted("%.0f, ", contacts.particleParticle) + formatted("%.0f", contacts.particleWall));
    line("largest relaxation number", formatted("%.3g", contacts.largestRelaxation));
    if (contacts.strongFrozen > 0) {
        line("WARNING: frozen contacts above x 0.5", formatted("%.0f", contacts.strongFrozen));
    }
    if (contacts.breakdowns > 0) {
        line("charges limited by breakdown", formatted("%.0f", contacts.breakdowns));
    }
    if (contacts.limitedForces > 0) {
        line("field forces limited", formatted("%.0f", contacts.limitedForces));
    }
}

}  // namespace

runReport::runReport(const Foam::Time& runTime, const PhaseTimes& times, long logInterval, double nearTime,
                     bool charges)
    : runTime_(runTime),
      times_(times),
      logInterval_(logInterval),
      nearTime_(nearTime),
      charges_(charges),
      firstTime_(runTime.value()),
      start_(Clock::now())
{
    recent_.emplace_back(firstTime_, 0);
}

bool runReport::logged() const
{
    const bool last = runTime_.value() > runTime_.endTime().value() - 0.5 * runTime_.deltaTValue();
    return runTime_.timeIndex() % logInterval_ == 0 || last;
}

double runReport::secondsSinceStart() const
{
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

double runReport::secondsLeft() const
{
    const double simulated = recent_.back().first - recent_.front().first;
    const double wall = recent_.back().second - recent_.front().second;
    // The last step may pass the end.
    const double left = std::max(0.0, runTime_.endTime().value() - runTime_.value());
    return simulated > 0 ? left * wall / simulated : 0;
}

void runReport::beginStep()
{
    Foam::solverPerformance::debug = logged() ? 1 : 0;
    if (logged()) {
        Info << "Time = " << runTime_.timeName() << "\n" << endl;
    }
}

void runReport::warnOfHeldPart(HeldPart& part, double frequency, double time)
{
    const double phase = time * frequency;
    // Not an error: the frequency is an upper estimate. A strong field of electrodes or of far charges does no harm when it is held.
    const auto passes = [&](double limit) { return phase > limit && part.phase <= limit; };
    const auto advice = [&](double limit) {
        return " Use at most " + formatted("%.2g", limit / frequency) + part.remedy + ".";
    };
    const std::string held = "WARNING: " + std::string(part.name) + " is held for " + formatted("%.3g", time)
                             + " s, omega T = " + formatted("%.2g", phase) + ", above ";
    if (passes(largestFieldPhase)) {
        Info << held.c_str() << largestFieldPhase
             << ", the limit of stability if its largest value is that of particles in contact: unlike charges that "
                "circle each other are torn apart, and clouds win energy without end."
             << advice(driftingFieldPhase).c_str() << endl;
    } else if (passes(driftingFieldPhase)) {
        Info << held.c_str() << driftingFieldPhase
             << ": charged particles move as far in this time as it takes to change their force. Approaching charges "
                "lose energy and circling ones win some."
             << advice(driftingFieldPhase).c_str() << endl;
    }
    part.phase = std::max(part.phase, phase);
}

void runReport::warnOfHeldField(const StepSummary& summary)
{
    const double update = runTime_.deltaTValue();
    warnOfHeldPart(whole_, summary.fieldFrequency, nearTime_ > 0 ? nearTime_ : update);
    if (nearTime_ > 0) {
        warnOfHeldPart(far_, summary.heldFrequency, update);
    }
}

void runReport::endStep(const CoupledStep& step)
{
    warnOfHeldField(step.summary());
    recent_.emplace_back(runTime_.value(), secondsSinceStart());
    if (recent_.size() > recentUpdates) {
        recent_.pop_front();
    }
    if (!logged()) {
        return;
    }
    if (charges_) {
        printCharges(step);
    }
    const double end = runTime_.endTime().value();
    const double done = end > firstTime_ ? 100 * (runTime_.value() - firstTime_) / (end - firstTime_) : 100;
    Info << ("Progress: " + formatted("%.1f", done) + " %, " + duration(secondsLeft()) + " left; "
             + shares(secondsOf(times_), secondsSinceStart()))
                .c_str()
         << endl;
    runTime_.printExecutionTime(Info);
}

void runReport::printCharges(const CoupledStep& step)
{
    const StepSummary& summary = step.summary();
    const auto number = [](double value) { return formatted("%.6g", value); };
    std::string line = "Charge: total " + number(summary.totalCharge) + " C, particle min "
                       + number(summary.smallestCharge) + " max " + number(summary.largestCharge) + " C, largest field "
                       + number(summary.largestField) + " V/m, books "
                       + formatted("%.2g", step.books().relativeClosureError());
    if (summary.excludedCount > 0) {
        line += ", outside the mesh " + std::to_string(summary.excludedCount) + " particle(s) with "
                + number(summary.excludedCharge) + " C";
    }
    Info << line.c_str() << endl;
}

void runReport::printSummary(const CoupledStep& step, const DemPort& dem, MPI_Comm communicator) const
{
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    std::array<double, phases> seconds = secondsOf(times_);
    MPI_Allreduce(MPI_IN_PLACE, seconds.data(), phases, MPI_DOUBLE, MPI_SUM, communicator);
    for (double& phase : seconds) {
        phase /= ranks;
    }
    const double wall = secondsSinceStart();
    const double simulated = runTime_.value() - firstTime_;

    std::ostringstream table;
    const auto line = [&table](const char* name, const std::string& value) {
        table << "    " << std::left << std::setw(36) << name << value << '\n';
    };
    line("simulated time [s]", formatted("%.6g", simulated));
    line("wall-clock time [s]", formatted("%.4g", wall));
    line("seconds per simulated second", simulated > 0 ? formatted("%.4g", wall / simulated) : "n/a");
    line("ranks", std::to_string(ranks));
    line("shares of time", shares(seconds, wall));
    line("particles", std::to_string(step.summary().particles));
    if (charges_) {
        line("near field held, largest omega T", formatted("%.2g", whole_.phase));
        if (nearTime_ > 0) {
            line("far field held, largest omega T", formatted("%.2g", far_.phase));
        }
        line("total charge [C]", formatted("%.6g", step.summary().totalCharge));
        addContacts(line, dem.contacts());
        line("charge books, closure error [C]", formatted("%.3g", step.books().closureError()));
        line("charge books, relative error", formatted("%.3g", step.books().relativeClosureError()));
    }
    Info << "\nSummary\n" << table.str().c_str() << endl;
}

}  // namespace him
