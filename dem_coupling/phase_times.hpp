// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <chrono>

namespace him {

/// Where the wall-clock time of a run goes.
enum class Phase { dem, near, deposit, poisson, gather, exchange, gas, output, count };

/// Seconds spent in each phase on this rank.
class PhaseTimes {
public:
    double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }
    void add(Phase phase, double seconds) { seconds_[static_cast<std::size_t>(phase)] += seconds; }
    static const char* name(Phase phase)
    {
        static constexpr std::array<const char*, static_cast<std::size_t>(Phase::count)> names{
            "DEM", "near sum", "deposit", "Poisson", "gather", "exchange", "gas", "output"};
        return names[static_cast<std::size_t>(phase)];
    }

private:
    std::array<double, static_cast<std::size_t>(Phase::count)> seconds_{};
};

/// Adds the time between its construction and destruction to a phase.
class PhaseTimer {
public:
    PhaseTimer(PhaseTimes& times, Phase phase) : times_(times), phase_(phase), start_(Clock::now()) {}
    ~PhaseTimer() { times_.add(phase_, std::chrono::duration<double>(Clock::now() - start_).count()); }
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    PhaseTimes& times_;
    Phase phase_;
    Clock::time_point start_;
};

}  // namespace him
