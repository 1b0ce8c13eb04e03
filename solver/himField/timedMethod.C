// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/timedMethod.H"

#include <algorithm>
#include <fstream>
#include <string>

namespace him {

namespace {

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// A line of /proc/self/status, summed over the ranks [MiB]; 0 where there is no such file.
double memory(const std::string& line, MPI_Comm communicator)
{
    std::ifstream status("/proc/self/status");
    double mebibytes = 0;
    for (std::string word; status >> word;) {
        if (word == line) {
            double kibibytes = 0;
            status >> kibibytes;
            mebibytes = kibibytes / 1024;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &mebibytes, 1, MPI_DOUBLE, MPI_SUM, communicator);
    return mebibytes;
}

}  // namespace

callTimes medianOf(const std::vector<callTimes>& calls)
{
    const auto of = [&](auto entry) {
        std::vector<double> values;
        std::transform(calls.begin(), calls.end(), std::back_inserter(values), entry);
        return median(values);
    };
    callTimes medians;
    for (std::size_t n = 0; n < fieldPhases.size(); ++n) {
        medians.phase[n] = of([n](const callTimes& c) { return c.phase[n]; });
    }
    medians.total = of([](const callTimes& c) { return c.total; });
    return medians;
}

double residentMemory(MPI_Comm communicator)
{
    return memory("VmRSS:", communicator);
}

double peakMemory(MPI_Comm communicator)
{
    return memory("VmHWM:", communicator);
}

void restartPeak()
{
    std::ofstream("/proc/self/clear_refs") << 5;
}

timedMethod::timedMethod(const FieldSettings& settings, snapshot& s, MPI_Comm communicator)
    : communicator_(communicator)
{
    MPI_Barrier(communicator);
    const double start = MPI_Wtime();
    FieldSettings withoutCharging = settings;
    withoutCharging.ownResponse = false;
    method_ = FieldMethod::create(withoutCharging, s.poisson.get(), s.box, s.periodic, communicator, times_);
    MPI_Barrier(communicator);
    createSeconds_ = MPI_Wtime() - start;
}

callTimes timedMethod::call(const DemParticles& particles)
{
    const PhaseTimes before = times_;
    MPI_Barrier(communicator_);
    const double start = MPI_Wtime();
    method_->compute(particles, result_);
    MPI_Barrier(communicator_);
    callTimes times;
    times.total = MPI_Wtime() - start;
    for (std::size_t n = 0; n < fieldPhases.size(); ++n) {
        times.phase[n] = times_.seconds(fieldPhases[n]) - before.seconds(fieldPhases[n]);
    }
    MPI_Allreduce(MPI_IN_PLACE, times.phase.data(), static_cast<int>(times.phase.size()), MPI_DOUBLE, MPI_MAX,
                  communicator_);
    MPI_Allreduce(MPI_IN_PLACE, &times.total, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    return times;
}

}  // namespace him
