// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/projective_charging.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace him {

namespace {

/// Sums of one group: number, q, gain; then about the means q q, q gain, gain gain.
constexpr std::size_t sumsPerGroup = 6;

/// What is left after one more burst of a way to q*, by the slope of the fit; nothing where the burst itself went all of it or more.
double leftByBurst(double slope)
{
    return std::max(0.0, 1 + slope);
}

/// A slope counts when it is this many standard errors below zero.
constexpr double significance = 2;

}  // namespace

ChargeProjection::ChargeProjection(const Scalars& chargeBefore, const Scalars& chargeAfter, const Scalars& share,
                                   const std::vector<int>& group, const std::vector<std::vector<double>>& equilibrium,
                                   MPI_Comm communicator)
    : share_(share), group_(group), groups_(equilibrium.size()), communicator_(communicator)
{
    if (chargeBefore.size() != chargeAfter.size() || chargeBefore.size() != share.size()
        || static_cast<std::size_t>(chargeBefore.size()) != group.size()) {
        throw std::invalid_argument("a burst needs the charges of the same particles before and after it");
    }
    const Scalars before = chargeBefore / share, after = chargeAfter / share;
    after_ = after;
    total_ = (chargeAfter - chargeBefore).sum();
    MPI_Allreduce(MPI_IN_PLACE, &total_, 1, MPI_DOUBLE, MPI_SUM, communicator_);
    std::vector<double> sums(sumsPerGroup * groups_.size(), 0.0);
    const auto add = [&](auto&& entry) {
        for (Index row = 0; row < before.size(); ++row) {
            entry(row, &sums[sumsPerGroup * static_cast<std::size_t>(group_[static_cast<std::size_t>(row)])]);
        }
    };
    const auto reduce = [&] {
        MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    };
    add([&](Index row, double* of) {
        of[0] += 1;
        of[1] += before[row];
        of[2] += after[row] - before[row];
    });
    reduce();
    const std::vector<double> first = sums;
    std::fill(sums.begin(), sums.end(), 0.0);
    add([&](Index row, double* of) {
        const double* mean = &first[static_cast<std::size_t>(of - sums.data())];
        const double q = before[row] - mean[1] / mean[0];
        const double gain = after[row] - before[row] - mean[2] / mean[0];
        of[3] += q * q;
        of[4] += q * gain;
        of[5] += gain * gain;
    });
    reduce();
    for (std::size_t n = 0; n < groups_.size(); ++n) {
        std::array<double, sumsPerGroup> of{};
        for (std::size_t k = 0; k < sumsPerGroup; ++k) {
            of[k] = k < 3 ? first[sumsPerGroup * n + k] : sums[sumsPerGroup * n + k];
        }
        fitGroup(groups_[n], of.data(), equilibrium[n]);
    }
    rest_.resize(before.size());
    for (Index row = 0; row < before.size(); ++row) {
        const Fit& fit = groups_[static_cast<std::size_t>(group_[static_cast<std::size_t>(row)])];
        rest_[row] = after[row] - before[row] - fit.gainAtZero - fit.slope * before[row];
    }
}

void ChargeProjection::fitGroup(Fit& fit, const double* sums, const std::vector<double>& equilibrium) const
{
    if (sums[0] == 0) {
        fit.held = true;
        return;
    }
    const double charge = sums[1] / sums[0];
    fit.meanGain = sums[2] / sums[0];
    // The equilibrium charge that the mean gain leads to, the farther one where there are several walls.
    double target = charge;
    for (const double one : equilibrium) {
        if ((one - charge) * fit.meanGain > 0 && std::fabs(one - charge) > std::fabs(target - charge)) {
            target = one;
        }
    }
    const bool known = target != charge;
    const double least = equilibrium.empty() ? 0 : *std::min_element(equilibrium.begin(), equilibrium.end());
    const double most = equilibrium.empty() ? 0 : *std::max_element(equilibrium.begin(), equilibrium.end());
    fit.lowest = least < 0 ? least : fit.lowest;
    fit.highest = most > 0 ? most : fit.highest;
    if (sums[0] >= 3 && sums[3] > 0) {
        const double slope = sums[4] / sums[3];
        const double scatter = std::max(0.0, sums[5] - slope * sums[4]) / (sums[0] - 2);
        const double limit = slope < 0 ? charge - fit.meanGain / slope : 0;
        const bool within = !known || (limit - target) * fit.meanGain <= 0;
        if (slope + significance * std::sqrt(scatter / sums[3]) < 0 && within) {
            fit.slope = slope;
            fit.fromBurst = true;
        }
    }
    if (!fit.fromBurst && known) {
        fit.slope = -fit.meanGain / (target - charge);
    }
    fit.gainAtZero = fit.meanGain - fit.slope * charge;
    fit.held = !fit.fromBurst && !known;
}

ChargeProjection::Leap ChargeProjection::leap(long bursts, double correlation, bool walls) const
{
    if (bursts < 0) {
        throw std::invalid_argument("a projection goes forward: its length must not be negative");
    }
    std::vector<double> growth(groups_.size()), factor(groups_.size());
    for (std::size_t n = 0; n < groups_.size(); ++n) {
        // (1 + c1)^n - 1, of a slope near zero to the last digit
        if (bursts > 0) {
            growth[n] = leftByBurst(groups_[n].slope) > 0
                            ? std::expm1(static_cast<double>(bursts) * std::log1p(groups_[n].slope))
                            : -1;
        }
        factor[n] = restFactor(bursts, correlation, groups_[n].slope);
    }
    Leap result;
    result.charge = after_;
    std::array<double, 4> sums{};  // gains, losses, stopped, gain that the fits expect of the next burst
    for (Index row = 0; row < after_.size(); ++row) {
        const auto n = static_cast<std::size_t>(group_[static_cast<std::size_t>(row)]);
        const Fit& fit = groups_[n];
        if (fit.held) {
            continue;
        }
        const double way = after_[row] - fit.limit();
        double change = fit.slope < 0 ? way * growth[n] : 0;
        change += factor[n] * rest_[row];
        if (fit.slope < 0 && way * (way + change) < 0) {
            change = -way;
            sums[2] += 1;
        } else if (change < 0 && after_[row] + change < fit.lowest) {
            change = std::min(0.0, fit.lowest - after_[row]);
            sums[2] += 1;
        } else if (change > 0 && after_[row] + change > fit.highest) {
            change = std::max(0.0, fit.highest - after_[row]);
            sums[2] += 1;
        }
        result.charge[row] += change;
        sums[change > 0 ? 0 : 1] += share_[row] * change;
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 3, MPI_DOUBLE, MPI_SUM, communicator_);
    result.stopped = static_cast<std::int64_t>(sums[2]);
    result.gained = sums[0] + sums[1];
    if (!walls && result.gained != 0) {
        // A smaller change never passes anything that the whole one does not pass.
        const bool up = result.gained > 0;
        const double part = up ? -sums[1] / sums[0] : -sums[0] / sums[1];
        for (Index row = 0; row < after_.size(); ++row) {
            const double change = result.charge[row] - after_[row];
            if ((change > 0) == up) {
                result.charge[row] = after_[row] + part * change;
            }
        }
        result.gained = 0;
    }
    for (Index row = 0; row < after_.size(); ++row) {
        const Fit& fit = groups_[static_cast<std::size_t>(group_[static_cast<std::size_t>(row)])];
        sums[3] += share_[row] * (fit.held ? fit.meanGain : fit.gainAtZero + fit.slope * result.charge[row]);
    }
    result.charge *= share_;
    MPI_Allreduce(&sums[3], &result.assumedGain, 1, MPI_DOUBLE, MPI_SUM, communicator_);
    return result;
}

double restFactor(long bursts, double correlation, double slope)
{
    const double rho = std::clamp(correlation, 0.0, 1.0);
    const double g = leftByBurst(slope);
    double sum = 1;      // S of k bursts beyond the first
    double cross = rho;  // sum over i = 0..k of g^(k-i) rho^(k+1-i)
    for (long k = 0; k < bursts; ++k) {
        sum = g * g * sum + 2 * g * cross + 1;
        cross = rho * (g * cross + 1);
    }
    return std::sqrt(sum) - std::pow(g, static_cast<double>(bursts));
}

double projectionError(double assumedGain, double foundGain)
{
    const double scale = std::max(std::fabs(assumedGain), std::fabs(foundGain));
    return scale == 0 ? 0 : std::fabs(foundGain - assumedGain) / scale;
}

}  // namespace him
