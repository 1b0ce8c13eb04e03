// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

namespace him {

/// Where the charge is and where it came from since the hand-over (of the first run, when this one continues it):
/// particles(t) = opening + inserted - removed - leaked - breakdown - sum over walls of what each wall was given.
class ChargeBooks {
public:
    /// Opens the books with the charge [C] on the particles, the sum of its absolute values, and the movements that a
    /// continued run starts with.
    void open(double particleCharge, double absoluteCharge, const ChargeMovements& earlier = {});
    /// New entries: charge on the particles now, sum of absolute charges, and all movements since the hand-over.
    void post(double particleCharge, double absoluteCharge, const ChargeMovements& movements);

    double particleCharge() const { return particleCharge_; }
    const ChargeMovements& movements() const { return movements_; }
    /// What does not add up [C].
    double closureError() const;
    /// closureError() relative to the largest sum of absolute charges (particles and everything moved) so far; 0 when
    /// no charge was ever there.
    double relativeClosureError() const;
    /// Largest sum of absolute charges so far [C].
    double scale() const { return scale_; }
    /// Above this relative error the run stops.
    static constexpr double tolerance = 1e-9;

private:
    double opening_ = 0;
    double particleCharge_ = 0;
    double scale_ = 0;
    ChargeMovements movements_;
};

}  // namespace him
