// SPDX-License-Identifier: GPL-3.0-or-later
#include "projectiveCharging/projectiveCharging.H"

#include "output/postProcessingFile.H"
#include "settings/checkedDictionary.H"

#include "OSspecific.H"
#include "Pstream.H"

#include <sstream>

namespace him {

namespace {

Foam::fileName companionOf(const Foam::fileName& checkpoint)
{
    return checkpoint + ".projection";
}

}  // namespace

std::unique_ptr<projectiveCharging> projectiveCharging::create(const Foam::Time& runTime,
                                                               const ProjectiveSettings& settings, DemPort& dem,
                                                               WallChargePort* faces, const Foam::fileName& checkpoint,
                                                               MPI_Comm communicator)
{
    if (!settings.active) {
        return nullptr;
    }
    std::unique_ptr<projectiveCharging> made(new projectiveCharging(runTime, settings, dem, faces, communicator));
    made->restore(checkpoint);
    return made;
}

projectiveCharging::projectiveCharging(const Foam::Time& runTime, const ProjectiveSettings& settings, DemPort& dem,
                                       WallChargePort* faces, MPI_Comm communicator)
    : runTime_(runTime), settings_(settings), run_(settings, dem, faces, communicator), startTime_(runTime.value())
{
    Foam::Info << "Projective charging: bursts of " << Foam::label(settings_.burst)
               << " field updates, each followed by the charging of " << Foam::label(settings_.leap) << " more\n"
               << Foam::endl;
    file_ = openPostProcessing(runTime, "projectiveCharging", "projectiveCharging.dat", 12);
    if (!file_.is_open()) {
        return;
    }
    file_ << "# One line per leap. chargingTime: simulated time and all leaps [s]. gain: of all particles in the burst "
             "[C].\n"
          << "# assumed: what the leap before had expected of it. error: their difference over the larger one; nan at "
             "the first leap.\n"
          << "# correlation: of what successive bursts give a particle beyond the fit. leapGain, toWalls: in the leap "
             "[C].\n"
          << "# stopped: particles that their rest would have carried beyond the limit. limit<t>, rate<t>: of particle "
             "type t, charge\n"
          << "# that its mean relaxes to [C] and c1, the change of the way there by one burst; nan where nothing is "
             "known.\n"
          << "# Time chargingTime gain assumed error correlation leapGain toWalls stopped limit1 rate1 ..."
          << std::endl;
}

void projectiveCharging::restore(const Foam::fileName& checkpoint)
{
    Foam::string text;
    if (Foam::Pstream::master()) {
        std::ifstream file(companionOf(checkpoint));
        std::ostringstream all;
        all << file.rdbuf();
        text = all.str();
    }
    Foam::Pstream::scatter(text);
    if (run_.restore(text)) {
        startBeyond_ = beyond();
    } else if (runTime_.value() > 0) {
        Foam::Info << "Projective charging begins anew: " << (text.empty() ? "there is no " : "it cannot be read, ")
                   << companionOf(checkpoint) << ", so charging time counts from here." << Foam::endl;
    }
}

void projectiveCharging::forget(const Foam::fileName& checkpoint)
{
    if (Foam::Pstream::master() && Foam::isFile(companionOf(checkpoint))) {
        Foam::rm(companionOf(checkpoint));
    }
}

void projectiveCharging::start(CoupledStep& step)
{
    run_.start(runTime_.value());
    step.setChargeChange([this](DemParticles& particles) {
        const bool leapt = run_.update(particles, runTime_.value());
        if (leapt) {
            writeLine();
        }
        return leapt;
    });
}

void projectiveCharging::writeLine()
{
    if (!file_.is_open()) {
        return;
    }
    const ProjectionRecord& now = run_.record();
    file_ << now.time << ' ' << now.time + now.beyond << ' ' << now.gain << ' ';
    if (run_.leaps() > 1) {
        file_ << now.expected << ' ' << now.error;
    } else {
        file_ << "nan nan";
    }
    file_ << ' ' << now.correlation << ' ' << now.leapGain << ' ' << now.givenToWalls << ' ' << now.stopped;
    for (const ChargeProjection::Fit& fit : now.fits) {
        if (fit.held) {
            file_ << " nan nan";
        } else {
            file_ << ' ' << fit.limit() << ' ' << fit.slope;
        }
    }
    file_ << std::endl;
}

void projectiveCharging::write(const Foam::fileName& checkpoint)
{
    if (run_.insideBurst() && !told_) {
        Foam::Info << "Projective charging: this checkpoint lies inside a burst; a run that continues from it begins a "
                      "new burst. Make the "
                      "write interval a multiple of the burst to continue exactly."
                   << Foam::endl;
        told_ = true;
    }
    if (Foam::Pstream::master()) {
        std::ofstream file(companionOf(checkpoint));
        file << run_.state() << '\n';
    }
}

void projectiveCharging::printSummary() const
{
    const double simulated = runTime_.value() - startTime_;
    Foam::Info << "Projective charging: " << simulated << " s stand for " << simulated + beyond() - startBeyond_
               << " s of charging; " << Foam::label(run_.leaps()) << " leaps, gain after a leap misjudged by "
               << shown(run_.meanError(), 3).c_str() << " on average and " << shown(run_.largestError(), 3).c_str()
               << " at most\n"
               << Foam::endl;
}

}  // namespace him
