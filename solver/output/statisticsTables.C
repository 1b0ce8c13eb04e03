// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/statisticsTables.H"

#include "output/postProcessingFile.H"

#include "Pstream.H"

#include <cmath>
#include <numeric>

namespace him {

namespace {

/// Digits of the tables: a continued fit starts from them.
constexpr int digits = 15;

/// Folder of postProcessing.
constexpr const char* group = "particleStatistics";

Foam::fileName folderOf(const Foam::Time& runTime)
{
    return runTime.globalPath() / "postProcessing" / group;
}

double sumOf(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

std::unique_ptr<statisticsTables> statisticsTables::create(const Foam::Time& runTime, const statisticsChoices& choices,
                                                           const std::vector<StatisticsRegion>& regions, DemPort& dem,
                                                           bool charges, pressureDropSource pressureDrop,
                                                           MPI_Comm communicator)
{
    if (!choices.active) {
        return nullptr;
    }
    std::unique_ptr<statisticsTables> made(
        new statisticsTables(runTime, choices, dem, charges, std::move(pressureDrop)));
    for (const StatisticsRegion& region : regions) {
        made->tables_.push_back({RegionStatistics(region, made->wallNames_.size(), communicator), {}, {}});
    }
    return made;
}

statisticsTables::statisticsTables(const Foam::Time& runTime, const statisticsChoices& choices, DemPort& dem,
                                   bool charges, pressureDropSource pressureDrop)
    : runTime_(runTime),
      dem_(dem),
      sampleInterval_(choices.sampleInterval),
      chargingSince_(choices.chargingSince),
      acceleration_(dem.chargingAcceleration()),
      charges_(charges),
      gravity_(dem.gravity()),
      wallNames_(gravity_.norm() > 0 ? dem.keepWallForces() : std::vector<std::string>()),
      pressureDrop_(std::move(pressureDrop))
{
}

double statisticsTables::timeOfCharging(double beyond) const
{
    return acceleration_ * (runTime_.value() - chargingSince_) + beyond;
}

void statisticsTables::openSeries(table& one)
{
    if (!Foam::Pstream::master()) {
        return;
    }
    const StatisticsRegion& region = one.statistics.region();
    for (const earlierSample& sample : readEarlierSeries(folderOf(runTime_), region.name, runTime_.value())) {
        one.saturation.add(sample.chargingTime, sample.chargePerMass);
    }
    one.series = openPostProcessing(runTime_, group, region.name + ".dat", digits);
    one.series << "# Region " << region.name << ". SI units: s, kg, C, C/kg, m/s, N, Pa.\n"
               << "# chargingTime: a t since charging began. saturation, tau, fitDeviation: fit of chargePerMass by "
                  "saturation (1 - exp(-chargingTime/tau)) (S6.1) so far; nan while the values show no bend.\n";
    if (region.layers > 0) {
        one.series << "# wallSpeed: root mean square speed in the first wall layer. forceOnWall: electrostatic force "
                      "of these towards "
                      "the wall. layer<n>: particles in the n-th layer of "
                   << region.layerThickness << " m.\n";
    }
    if (withWeight()) {
        one.series << "# weight: of the particles. wallShare: part of it that contacts with walls carry; by_<wall>: "
                      "each wall's part.\n";
    }
    one.series << "# Time chargingTime particles mass charge chargePerMass meanCharge saturation tau fitDeviation";
    if (region.layers > 0) {
        one.series << " wallParticles wallSpeed forceOnWall";
    }
    for (int layer = 1; layer <= region.layers; ++layer) {
        one.series << " layer" << layer;
    }
    if (withWeight()) {
        one.series << " weight wallShare";
        for (const std::string& name : wallNames_) {
            one.series << " by_" << name;
        }
    }
    one.series << (pressureDrop_ ? " pressureDrop" : "") << std::endl;
}

void statisticsTables::writeLine(table& one, const RegionSample& sample, double pressure, double chargingTime)
{
    if (!Foam::Pstream::master()) {
        return;
    }
    const RegionSums& sums = sample.sums;
    if (charges_ && sums.particles > 0) {
        one.saturation.add(chargingTime, sums.chargePerMass());
    }
    const SaturationCurve& curve = one.saturation.curve();
    std::ofstream& out = one.series;
    out << runTime_.value() << ' ' << chargingTime << ' ' << sums.particles << ' ' << sums.mass << ' ' << sums.charge
        << ' ' << sums.chargePerMass() << ' ' << sums.meanCharge();
    if (curve.known) {
        out << ' ' << curve.limit << ' ' << curve.timeScale << ' ' << curve.deviation;
    } else {
        out << " nan nan nan";
    }
    if (one.statistics.region().layers > 0) {
        out << ' ' << sums.wallParticles << ' ' << sums.wallSpeed() << ' ' << sums.forceOnWall;
    }
    for (const double layer : sums.layers) {
        out << ' ' << layer;
    }
    if (withWeight()) {
        const double share = sample.weight > 0 ? 1 / sample.weight : 0;
        out << ' ' << sample.weight << ' ' << sumOf(sample.carriedByWall) * share;
        for (const double carried : sample.carriedByWall) {
            out << ' ' << carried * share;
        }
    }
    if (pressureDrop_) {
        out << ' ' << pressure;
    }
    out << std::endl;
}

void statisticsTables::start(const CoupledStep& step, double chargingTime)
{
    // The hand-over may have put the particles into another order; forces of walls belong to the new one.
    DemParticles now;
    dem_.particles(now);
    dem_.wallForces(wallForces_);
    const Points none = Points::Zero(now.size(), 3);
    const double pressure = pressureDrop_ ? pressureDrop_() : 0;
    for (table& one : tables_) {
        openSeries(one);
        RegionSample sample = one.statistics.sample(step.particles(), step.field().field, {}, gravity_);
        sample.carriedByWall = one.statistics.sample(now, none, wallForces_, gravity_).carriedByWall;
        writeLine(one, sample, pressure, timeOfCharging(chargingTime));
    }
}

void statisticsTables::update(const CoupledStep& step, double chargingTime)
{
    if (runTime_.timeIndex() % sampleInterval_ == 0) {
        dem_.wallForces(wallForces_);
        const double pressure = pressureDrop_ ? pressureDrop_() : 0;
        for (table& one : tables_) {
            const RegionSample sample =
                one.statistics.sample(step.particles(), step.field().field, wallForces_, gravity_);
            one.statistics.average(step.particles(), step.field().field, sample);
            one.pressureDrop += pressure;
            writeLine(one, sample, pressure, timeOfCharging(chargingTime));
        }
    }
    if (runTime_.writeTime()) {
        for (table& one : tables_) {
            writeAverages(one);
            one.statistics.beginAverages();
            one.pressureDrop = 0;
        }
    }
}

void statisticsTables::writeAverages(table& one)
{
    const StatisticsRegion& region = one.statistics.region();
    const double samples = one.statistics.samples();
    const RegionSample mean = one.statistics.averages();
    const std::vector<WallProfile::Row> profile = one.statistics.profile();
    const std::vector<double> counts = one.statistics.chargeCounts();
    if (!Foam::Pstream::master() || samples == 0) {
        return;
    }
    const auto open = [&](const char* name, std::ofstream& file) {
        file = openPostProcessing(runTime_, group, region.name + name, digits);
        file << "# Region " << region.name << ", " << samples << " samples up to " << runTime_.value()
             << " s. SI units.\n";
    };
    {
        std::ofstream file;
        open("Averages.dat", file);
        file << "particles " << mean.sums.particles << "\nmass " << mean.sums.mass << "\ncharge " << mean.sums.charge
             << "\nchargePerMass " << mean.sums.chargePerMass() << "\nmeanCharge " << mean.sums.meanCharge() << '\n';
        if (region.layers > 0) {
            file << "wallParticles " << mean.sums.wallParticles << "\nwallSpeed " << mean.sums.wallSpeed()
                 << "\nforceOnWall " << mean.sums.forceOnWall << '\n';
        }
        for (std::size_t layer = 0; layer < mean.sums.layers.size(); ++layer) {
            file << "layer" << layer + 1 << ' ' << mean.sums.layers[layer] << '\n';
        }
        if (withWeight()) {
            const double share = mean.weight > 0 ? 1 / mean.weight : 0;
            file << "weight " << mean.weight << "\nwallShare " << sumOf(mean.carriedByWall) * share << '\n';
            for (std::size_t wall = 0; wall < wallNames_.size(); ++wall) {
                file << "by_" << wallNames_[wall] << ' ' << mean.carriedByWall[wall] * share << '\n';
            }
        }
        if (pressureDrop_) {
            file << "pressureDrop " << one.pressureDrop / samples << '\n';
        }
        const SaturationCurve& curve = one.saturation.curve();
        if (curve.known) {
            file << "saturation " << curve.limit << "\ntau " << curve.timeScale << "\nfitDeviation " << curve.deviation
                 << '\n';
        }
    }
    if (!counts.empty()) {
        std::ofstream file;
        open("ChargePDF.dat", file);
        const auto bins = static_cast<std::size_t>(one.statistics.histogram().bins());
        const std::vector<double> density = one.statistics.histogram().density(counts);
        const double all = sumOf(counts);
        file << "# Share of particles below the range " << (all > 0 ? counts[bins] / all : 0) << ", above it "
             << (all > 0 ? counts[bins + 1] / all : 0) << ".\n# charge [C], density [1/C], share of particles\n";
        for (std::size_t bin = 0; bin < bins; ++bin) {
            file << one.statistics.histogram().centre(static_cast<int>(bin)) << ' ' << density[bin] << ' '
                 << (all > 0 ? counts[bin] / all : 0) << '\n';
        }
    }
    if (!profile.empty()) {
        std::ofstream file;
        open("Profile.dat", file);
        file << "# distance from the nearest wall [m], number density [1/m3], mean charge [C], mean electrostatic "
                "force towards the "
                "wall [N]\n";
        for (const WallProfile::Row& row : profile) {
            file << row.distance << ' ' << row.numberDensity << ' ' << row.meanCharge << ' ' << row.meanForce << '\n';
        }
    }
}

}  // namespace him
