// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/gasPhase.H"

#include "output/postProcessingFile.H"
#include "settings/checkedDictionary.H"

#include "foamPoissonMesh/conversions.H"

#include "dem_coupling/gas/lift.hpp"

#include "IOdictionary.H"
#include "coupledPolyPatch.H"
#include "emptyPolyPatch.H"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace him {

namespace {

/// A gas step grows by no more than this factor at once.
constexpr double growth = 1.2;

/// Collective.
std::vector<Foam::label> listedPatches(const Foam::fvMesh& mesh)
{
    std::vector<Foam::label> listed;
    for (const Foam::polyPatch& patch : mesh.boundaryMesh()) {
        // One without faces, which a tool may have left over, has no mean pressure.
        if (!Foam::isA<Foam::coupledPolyPatch>(patch) && !Foam::isA<Foam::emptyPolyPatch>(patch)
            && Foam::returnReduce(patch.size(), Foam::sumOp<Foam::label>()) > 0) {
            listed.push_back(patch.index());
        }
    }
    return listed;
}

/// What velocityInterpolation asks for.
std::unique_ptr<VelocityProfile> profileOf(const GasSettings& settings, const Foam::volVectorField& U)
{
    if (settings.velocity == VelocityInterpolation::cell) {
        return nullptr;
    }
    // The diffusion of `smoothed` takes no notice of walls.
    return std::make_unique<cellPointVelocity>(U, settings.voidFraction != VoidFractionModel::smoothed);
}

void append(std::ostream& line, const Vector3& vector)
{
    line << ' ' << vector[0] << ' ' << vector[1] << ' ' << vector[2];
}

/// What a warning says of particles that the chosen drag law has not been shown for.
std::string beyondDragLaw(const GasSummary& summary)
{
    std::string names;
    for (const std::string& name : dragLawNames(summary.othersBeyondDragLaw)) {
        names += (names.empty() ? "" : ", ") + name;
    }
    return "Void fractions there are " + shown(summary.voidFractionsBeyondDragLaw[0], 3) + " to "
           + shown(summary.voidFractionsBeyondDragLaw[1], 3) + ", Re up to " + shown(summary.reynoldsBeyondDragLaw, 3)
           + (names.empty() ? "; no law has for all of them: a run with another one shows how much hangs on it"
                            : "; these have for all of them: " + names);
}

}  // namespace

gasPhase::gasPhase(const Foam::fvMesh& mesh, const gasProperties& properties, DemPort& dem, PhaseTimes& times,
                   MPI_Comm communicator)
    : mesh_(mesh),
      properties_(properties),
      dem_(dem),
      times_(times),
      cells_(mesh),
      flow_(mesh, properties.exchange, properties.pimple, !properties.turbulence.empty()),
      profile_(profileOf(properties.exchange, flow_.velocity())),
      coupling_(dem, cells_, properties.exchange, communicator, profile_.get()),
      earlier_(readState(mesh.time())),
      listed_(listedPatches(mesh))
{
    if (properties_.maxDeltaT == 0) {
        properties_.maxDeltaT = mesh.time().deltaTValue();
    }
    file_ = openPostProcessing(mesh.time(), "gas", "gas.dat", 17);
    if (!file_.is_open()) {
        return;
    }
    file_
        << "# SI units. p_<patch>: area average of p without the hydrostatic part; in_<patch>: inflow of gas [m3/s].\n"
        << "# force: of drag and pressure gradient on all particles. given, got: impulse, sums since the start.\n"
        << "# Time deltaT Co";
    for (const Foam::label patch : listed_) {
        const Foam::word& name = mesh_.boundaryMesh()[patch].name();
        file_ << " p_" << name << " in_" << name;
    }
    file_ << " forceX forceY forceZ massCentreX massCentreY massCentreZ solidVolume smallestVoidFraction boundedCells"
             " boundedVolume givenX givenY givenZ gotX gotY gotZ mismatch gasMomentumX gasMomentumY gasMomentumZ"
             " particleMomentumX particleMomentumY particleMomentumZ"
          << std::endl;
}

void gasPhase::start(const DemParticles& particles)
{
    const PhaseTimer timer(times_, Phase::gas);
    if (flow_.continued()) {
        const double duration = earlier_.demSteps > 0 ? static_cast<double>(earlier_.demSteps) * dem_.timeStep()
                                                      : mesh_.time().deltaTValue();
        coupling_.resume(particles, flow_.result(), duration, earlier_.ahead);
    } else {
        coupling_.begin(particles);
    }
    flow_.setVoidFraction(coupling_.sources().voidFraction);
}

void gasPhase::advance(const DemParticles& particles)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        coupling_.collect(particles, flow_.result().velocity);
    }
    {
        const PhaseTimer timer(times_, Phase::gas);
        flow_.solve(coupling_.sources());
        courant_ = flow_.courantNumber();
    }
    const PhaseTimer timer(times_, Phase::exchange);
    coupling_.handBack(particles, flow_.result(), mesh_.time().deltaTValue());
}

gasPhase::State gasPhase::readState(const Foam::Time& time)
{
    State state;
    Foam::IOobject header("gas", time.timeName(), "uniform", time, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE,
                          false);
    if (!header.typeHeaderOk<Foam::IOdictionary>(true)) {
        return state;
    }
    const Foam::IOdictionary written(header);
    state.demSteps = written.get<Foam::label>("demSteps");
    state.nextDemSteps = written.get<Foam::label>("nextDemSteps");
    state.ahead = toEigen(written.get<Foam::vector>("ahead"));
    return state;
}

void gasPhase::writeState(long demSteps) const
{
    if (!mesh_.time().writeTime()) {
        return;
    }
    // Before the entries are made: they keep their digits.
    const unsigned precision = Foam::IOstream::defaultPrecision(17);
    Foam::IOdictionary state(Foam::IOobject("gas", mesh_.time().timeName(), "uniform", mesh_.time(),
                                            Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false));
    state.add("demSteps", static_cast<Foam::label>(demSteps));
    state.add("nextDemSteps", static_cast<Foam::label>(nextDemSteps(demSteps)));
    state.add("ahead", toFoam(coupling_.books().ahead));
    state.regIOobject::write();
    Foam::IOstream::defaultPrecision(precision);
}

long gasPhase::firstDemSteps(long ofCase) const
{
    return properties_.adjustTimeStep && earlier_.nextDemSteps > 0 ? earlier_.nextDemSteps : ofCase;
}

long gasPhase::nextDemSteps(long current) const
{
    if (!properties_.adjustTimeStep) {
        return current;
    }
    const double byCourant = courant_ > 0 ? properties_.maxCo / courant_ : growth;
    const double wanted = static_cast<double>(current) * std::min(growth, byCourant);
    // Growth of less than one step must not be rounded away for ever.
    const long steps = byCourant >= growth ? std::lround(std::ceil(wanted)) : std::lround(std::floor(wanted));
    const long most = std::lround(std::floor(properties_.maxDeltaT / dem_.timeStep() * (1 + 1e-9)));
    return std::max(1L, std::min(steps, most));
}

double gasPhase::pressureOn(Foam::label patch) const
{
    const Foam::scalarField& areas = mesh_.magSf().boundaryField()[patch];
    return Foam::gSum(Foam::scalarField(areas * flow_.pressure().boundaryField()[patch])) / Foam::gSum(areas);
}

void gasPhase::writeLine(double time, const DemParticles& particles)
{
    coupling_.sumMotion(particles);
    std::ostringstream patches;
    patches.precision(12);
    for (const Foam::label patch : listed_) {
        patches << ' ' << pressureOn(patch) << ' '
                << -Foam::gSum(Foam::scalarField(flow_.voidFraction().boundaryField()[patch]
                                                 * flow_.flux().boundaryField()[patch]));
    }
    const Vector3 gasMomentum = flow_.momentum();
    if (!file_.is_open()) {
        return;
    }
    const GasSummary& summary = coupling_.summary();
    const MomentumBooks& books = coupling_.books();
    file_ << time << ' ' << mesh_.time().deltaTValue() << ' ' << courant_ << patches.str();
    append(file_, summary.force);
    append(file_, summary.massCentre);
    file_ << ' ' << summary.solidVolume << ' ' << summary.smallestVoidFraction << ' ' << summary.boundedCells << ' '
          << summary.boundedVolume;
    append(file_, books.given);
    append(file_, books.got);
    file_ << ' ' << books.mismatch();
    append(file_, gasMomentum);
    append(file_, coupling_.summary().momentum);
    file_ << std::endl;
}

std::string gasPhase::describe() const
{
    const GasSummary& summary = coupling_.summary();
    std::string line = "Gas: deltaT " + shown(mesh_.time().deltaTValue()) + " s, Courant number " + shown(courant_, 3)
                       + ", force on the particles (" + shown(summary.force[0]) + " " + shown(summary.force[1]) + " "
                       + shown(summary.force[2]) + ") N, smallest void fraction "
                       + shown(summary.smallestVoidFraction, 3);
    if (summary.boundedCells > 0) {
        line += ", below " + shown(properties_.exchange.smallestVoidFraction, 3) + " in "
                + std::to_string(summary.boundedCells) + " cell(s), which hold " + shown(summary.boundedVolume, 3)
                + " m3 more than the gas sees";
    }
    if (summary.particlesOutside > 0) {
        line += ", outside the mesh " + std::to_string(summary.particlesOutside) + " particle(s)";
    }
    if (summary.beyondDragLaw > 0) {
        line += "\n    Warning: " + std::to_string(summary.beyondDragLaw) + " particle(s) where drag "
                + properties_.exchange.drag + " has not been shown to hold ("
                + dragLawRangeInWords(properties_.exchange.drag) + "). " + beyondDragLaw(summary);
    }
    if (summary.beyondLift > 0) {
        line += "\n    Warning: " + std::to_string(summary.beyondLift)
                + " particle(s) where Saffman's lift does not hold (" + saffmanRangeInWords
                + "). A run without `lift` shows how much hangs on it";
    }
    return line;
}

}  // namespace him
