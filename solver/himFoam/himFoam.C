// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    himFoam

Description
    Charged particles: DEM by LIGGGHTS, contact charging, and the electric
    field by a mesh (Poisson's equation with near sum and correction, HIM) or
    by pair sums, coupled once per field update deltaT.

Usage
    himFoam [-case DIR] [-parallel] [-dry-run]

    -dry-run checks the whole case, the DEM script included, and stops before
    the first step. Everything that is wrong is listed at once, in three
    stages; the exit code is then 1. See solver/doc/himFoam.md for all entries.

SourceFiles
    himFoam.C
    scene.C
\*---------------------------------------------------------------------------*/
#include "gas/gasPhase.H"
#include "himFoam/scene.H"
#include "output/chargeTable.H"
#include "output/fieldErrorTable.H"
#include "output/particleWriter.H"
#include "output/runReport.H"
#include "output/statisticsTables.H"
#include "parallel/session.H"
#include "projectiveCharging/projectiveCharging.H"

#include "dem_coupling/near_field_refresh.hpp"

#include "OSspecific.H"
#include "profiling.H"

#include <cstdio>
#include <optional>
#include <stdexcept>

namespace him {

namespace {

/// LIGGGHTS restart file of the current time.
Foam::fileName checkpointOf(const scene& s)
{
    return Foam::fileName(s.settings.demScript).path() / "restart" / s.runTime().timeName();
}

/// Fields, particles and DEM checkpoint, when it is time for them.
void write(scene& s, const CoupledStep& step, particleWriter& particles, projectiveCharging* projection,
           PhaseTimes& times)
{
    const PhaseTimer timer(times, Phase::output);
    s.runTime().write();
    if (!s.runTime().writeTime()) {
        return;
    }
    particles.write(step.particles(), step.field().field);
    if (s.insulatingWalls) {
        s.insulatingWalls->write(s.runTime());
    } else if (s.poisson && s.poisson->matter()) {
        s.poisson->matter()->write();
    }
    if (s.settings.demCheckpoint) {
        const Foam::fileName checkpoint = checkpointOf(s);
        Foam::mkDir(checkpoint.path());
        s.dem->writeCheckpoint(checkpoint);
        if (projection) {
            projection->write(checkpoint);
        } else {
            projectiveCharging::forget(checkpoint);
        }
    }
}

/// What the case's statistics take as pressure drop; empty without.
pressureDropSource pressureDropOf(const scene& s, const gasPhase* gas)
{
    if (!gas || !s.settings.statistics.pressureDrop) {
        return {};
    }
    const pressureDropChoice& choice = *s.settings.statistics.pressureDrop;
    const Foam::label inlet = s.gasMesh().boundaryMesh().findPatchID(choice.inlet);
    const Foam::label outlet = s.gasMesh().boundaryMesh().findPatchID(choice.outlet);
    return [gas, inlet, outlet, empty = choice.emptyColumn] {
        return gas->pressureOn(inlet) - gas->pressureOn(outlet) - empty;
    };
}

void handOverPointField(scene& s, FieldMethod& method)
{
    auto* user = dynamic_cast<PointFieldUser*>(s.dem.get());
    if (user && user->usesPointField() && method.pointField()) {
        user->setPointField(*method.pointField());
    }
}

void run(scene& s, MPI_Comm communicator)
{
    Foam::Time& runTime = s.runTime();
    PhaseTimes times;
    const auto method = s.settings.electrostatics ? FieldMethod::create(s.settings.field, s.poisson.get(), s.dem->box(),
                                                                        s.dem->periodic(), communicator, times)
                                                  : FieldMethod::none();
    handOverPointField(s, *method);
    const auto nearField = NearFieldRefresh::create(s.settings.field, s.poisson.get(), *s.dem, communicator, times);
    CoupledStep step(*s.dem, *method, communicator, times);
    step.setWallCharges(s.insulatingWalls.get());
    step.setNearField(nearField.get());
    std::optional<chargeTable> charge;
    if (s.settings.electrostatics) {
        charge.emplace(runTime, s.dem->walls(), step.hasInsulatingWalls());
    }
    std::optional<gasPhase> gas;
    if (s.settings.gas) {
        gas.emplace(s.gasMesh(), *s.settings.gas, *s.dem, times, communicator);
    }
    const Foam::fvMesh* cloudMesh = s.poisson ? &s.poisson->mesh() : gas ? &s.gasMesh() : nullptr;
    const CellMesh* cloudCells = s.poisson ? static_cast<const CellMesh*>(s.poisson.get())
                                 : gas     ? &gas->cells()
                                           : nullptr;
    const auto particles =
        particleWriter::create(runTime, cloudMesh, cloudCells, s.dem->box(), s.dem->periodic(), communicator);
    fieldErrorTable fieldError(runTime, s.settings.fieldError, s.settings.field, s.poisson.get(), s.dem->box(),
                               s.dem->periodic(), communicator);
    const auto projection = projectiveCharging::create(runTime, s.settings.projectiveCharging, *s.dem,
                                                       s.insulatingWalls.get(), checkpointOf(s), communicator);
    const auto statistics = statisticsTables::create(runTime, s.settings.statistics, s.statisticsRegions, *s.dem,
                                                     s.dem->charging() && !s.settings.fixedUniformCharge,
                                                     pressureDropOf(s, gas ? &*gas : nullptr), communicator);
    runReport report(runTime, times, s.settings.logInterval,
                     static_cast<double>(s.settings.field.nearField.interval) * s.dem->timeStep(),
                     s.settings.electrostatics);

    Foam::Info << "\nStarting time loop\n" << Foam::endl;
    if (s.settings.fixedUniformCharge) {
        s.dem->stopCharging();
        printUniformCharge(replaceByMean(*s.dem, communicator));
    }
    step.start();
    report.warnOfHeldField(step.summary());
    if (s.settings.field.ownResponse) {
        printOwnResponse(*method);
    }
    printOwnCellField(*method, step.particles());
    if (charge) {
        charge->write(runTime.value(), step);
    }
    fieldError.update(step);
    if (projection) {
        projection->start(step);
    }
    if (statistics) {
        statistics->start(step, projection ? projection->beyond() : 0);
    }
    if (gas) {
        gas->start(step.particles());
    }
    long demSteps = gas ? gas->firstDemSteps(s.demSteps) : s.demSteps;
    if (demSteps != s.demSteps) {
        runTime.setDeltaT(static_cast<double>(demSteps) * s.dem->timeStep(), false);
    }
    double deltaT = runTime.deltaTValue();
    while (runTime.loop()) {
        if (runTime.deltaTValue() != deltaT) {
            throw std::runtime_error("deltaT was changed during the run; stop and start again to change it.");
        }
        report.beginStep();
        step.advance(demSteps);
        if (gas) {
            gas->advance(step.particles());
        }
        if (runTime.timeIndex() % s.settings.chargeInterval == 0) {
            if (charge) {
                charge->write(runTime.value(), step);
            }
            if (gas) {
                gas->writeLine(runTime.value(), step.particles());
            }
        }
        {
            // Before the checkpoint, which puts the particles of the DEM in another order when some change their rank.
            const PhaseTimer timer(times, Phase::output);
            fieldError.update(step);
            if (statistics) {
                statistics->update(step, projection ? projection->beyond() : 0);
            }
        }
        write(s, step, *particles, projection.get(), times);
        if (gas) {
            gas->writeState(demSteps);
        }
        if (gas && report.logged()) {
            Foam::Info << gas->describe().c_str() << Foam::endl;
        }
        report.endStep(step);
        if (gas && gas->nextDemSteps(demSteps) != demSteps) {
            demSteps = gas->nextDemSteps(demSteps);
            deltaT = static_cast<double>(demSteps) * s.dem->timeStep();
            runTime.setDeltaT(deltaT, false);
        }
    }
    report.printSummary(step, *s.dem, communicator);
    if (projection) {
        projection->printSummary();
    }
    Foam::Info << "End\n" << Foam::endl;
}

void runCase(const Foam::argList& args, MPI_Comm communicator)
{
    scene s;
    openCase(args, s, communicator);
    openDem(s, communicator);
    if (args.found("dry-run")) {
        Foam::Info << "Dry run: the case is fine; stopping before the first step.\n" << Foam::endl;
    } else {
        run(s, communicator);
    }
}

}  // namespace

}  // namespace him

int main(int argc, char* argv[])
{
    // LIGGGHTS may end the process right after its message, which must not get lost in a buffer.
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    Foam::argList::addNote("Charged particles: DEM by LIGGGHTS, contact charging, electric field by HIM or pair sums.");
    Foam::argList::addBoolOption("dry-run", "Check the whole case and stop before the first step");
    // A case without a mesh runs in parallel too; openMesh checks the processor folders of the others.
    Foam::argList::noCheckProcessorDirectories();
    return him::runSession(argc, argv, him::runCase);
}
