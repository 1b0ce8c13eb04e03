// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <mpi.h>

namespace him {

/// Projective integration of slow charging: a burst of true charging (a = 1) over a time tau says how fast particles gain
/// charge at which charge; then the charges are moved on over a longer time without contacts.
///
/// The gain of a burst is fitted over all particles as gain = c0 + c1 q. Extrapolating each particle's own gain instead would
/// give the few that touched a wall during the burst the charge of many contacts, which is what an acceleration factor does;
/// the fit takes particles of equal charge for equal, as they are when the bed mixes faster than it charges. What chance
/// contacts would add to the spread of charges during the projection is lost: with bursts over a tenth of the time a well mixed
/// bed keeps its mean within 1 % and a third of its spread, where an acceleration by 10 makes the spread three times too wide
/// (projective_charging_test.cpp).
class ChargeProjection {
public:
    /// Fit of one burst. Collective.
    /// @param before, after  charges of this rank's particles at the ends of the burst, in the same order [C]
    ChargeProjection(const Scalars& before, const Scalars& after, MPI_Comm communicator);

    /// Charges after `bursts` more times the duration of the burst: q* + (q - q*) exp(c1 bursts) with q* = -c0/c1, which
    /// comes nearer to q* and never passes it. Where charges run away from each other (c1 >= 0), and where the fit is
    /// nothing but noise (fewer than three particles, equal charges), all gain the mean of the burst.
    Scalars project(const Scalars& charge, double bursts) const;

    /// Total gain of all particles in such a projection, over that of the burst: walls give charge in this proportion, so
    /// that the sum of particles and walls stays. 0 when the burst moved nothing.
    double wallFactor(const Scalars& charge, double bursts, MPI_Comm communicator) const;

    double gainAtZero() const { return c0_; }  ///< [C per burst]
    double slope() const { return c1_; }       ///< [1 per burst]
    double totalGain() const { return total_; }  ///< of the burst, all ranks [C]
    bool relaxes() const { return c1_ < 0; }

private:
    double c0_ = 0, c1_ = 0, total_ = 0, mean_ = 0;
};

/// How far a projection was off, seen from the burst after it: the difference between the gain that this burst makes and the
/// one that the projection assumed at its end, over the larger of the two; 0 is perfect, above 1 the sign was wrong.
double projectionError(double assumedGain, double foundGain);

}  // namespace him
