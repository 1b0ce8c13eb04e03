// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <cstdint>
#include <limits>
#include <mpi.h>
#include <vector>

namespace him {

/// Projective integration of slow charging: a burst of true charging (a = 1) says how fast particles gain charge at which charge;
/// then the charges leap on by the time of many bursts at once, while nothing moves.
///
/// Particles are fitted in groups (DEM types), with charges over their share s = (d/mean d)^2 of the equilibrium charge, which grows with
/// the surface (S2.14): gain of a burst = c0 + c1 q + rest of q/s, so that the mean of a group relaxes to
/// q* = -c0/c1 as q* + (q - q*) (1 + c1)^n and never passes it. Where the burst does not show the relaxation (c1 not negative beyond
/// its standard error, or q* beyond the equilibrium charge of the group) q* is the equilibrium charge, and the rate that of the mean
/// gain. A group whose mean gain leads away from its equilibrium charge, or that has none, is held.
///
/// The rest of each particle, what chance or its place gave it beyond the fit, is multiplied by a common factor that makes the
/// spread grow as n bursts would make it: rests of successive bursts whose correlation is rho add up like a first-order
/// autoregression. With rho = 0 (the bed mixes faster than a burst) that is a random walk, with rho = 1 (particles stay where they
/// are) every particle goes on with its own gain. Without this the spread of a mixed bed comes out three times too narrow
/// (projective_charging_test.cpp). A particle that its rest would carry beyond q*, or from there beyond the equilibrium
/// charge, stops there and is counted.
class ChargeProjection {
public:
    /// One group.
    struct Fit {
        double gainAtZero = 0;                                  ///< c0 [C per burst]
        double slope = 0;                                       ///< c1 [1 per burst], never positive
        double meanGain = 0;                                    ///< [C per burst]
        bool fromBurst = false;                                 ///< the burst shows the relaxation by itself
        bool held = false;                                      ///< no leap
        double lowest = std::numeric_limits<double>::lowest();  ///< equilibrium charges that no leap passes [C]
        double highest = std::numeric_limits<double>::max();
        double limit() const { return slope < 0 ? -gainAtZero / slope : 0; }  ///< q* [C]
    };

    /// Fit of one burst. Collective.
    /// @param before, after  charges of this rank's particles at the ends of the burst, in the same order [C]
    /// @param share          s of each of them
    /// @param group          of each of them, from 0
    /// @param equilibrium    equilibrium charges of each group, of s = 1 [C] (positive and negative ones may be known; empty: none)
    /// Throws std::invalid_argument for different lengths.
    ChargeProjection(const Scalars& before, const Scalars& after, const Scalars& share, const std::vector<int>& group,
                     const std::vector<std::vector<double>>& equilibrium, MPI_Comm communicator);

    const std::vector<Fit>& groups() const { return groups_; }
    /// What each particle gained beyond the fit of its group, over s [C].
    const Scalars& rest() const { return rest_; }

    struct Leap {
        Scalars charge;            ///< of each particle afterwards [C]
        double gained = 0;         ///< total, all ranks [C]
        double assumedGain = 0;    ///< of the next burst, all ranks, by the fits [C]
        std::int64_t stopped = 0;  ///< particles that stopped at q* or at equilibrium, all ranks
    };
    /// Charges after `bursts` more bursts. Collective.
    /// @param correlation  rho of the rests of successive bursts; outside [0, 1] the nearest end counts
    /// @param walls        whether walls take or give the difference. If not, the sum must stay: of gains and losses the
    ///                     larger side is scaled down.
    Leap leap(long bursts, double correlation, bool walls) const;

    double totalGain() const { return total_; }  ///< of the burst, all ranks [C]

private:
    void fitGroup(Fit& fit, const double* sums, const std::vector<double>& equilibrium) const;

    Scalars share_, after_, rest_;  ///< s; charge at the end of the burst and rest, over s [C]
    std::vector<int> group_;
    std::vector<Fit> groups_;
    MPI_Comm communicator_;
    double total_ = 0;
};

/// By how much the rest of the last burst is multiplied over a leap of `bursts` bursts, see ChargeProjection: sqrt(S) - g^n, where
/// S sums g^(2n-i-j) rho^|i-j| over i, j = 0..n and g = 1 + slope, 0 for a slope below -1.
double restFactor(long bursts, double correlation, double slope);

/// How far a projection was off, seen from the burst after it: the difference between the gain that this burst makes and the
/// one that the projection assumed at its end, over the larger of the two; 0 is perfect, above 1 the sign was wrong.
double projectionError(double assumedGain, double foundGain);

}  // namespace him
