// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/compensated_sum.hpp"

#include <cstdint>

namespace him {

/// Charge that leaves particles without a contact: leakage to ground and dielectric breakdown of the gas. Both are off
/// until their numbers are set.
class ChargeLosses {
public:
    /// q falls as exp(-t/tau); what is lost goes to ground. Throws std::invalid_argument unless tau [s] is positive.
    void setRelaxationTime(double relaxationTime);
    /// Largest field [V/m] that a particle's own charge may make at its surface. What exceeds it is lost at once. Throws
    /// std::invalid_argument unless it is positive.
    void setBreakdownField(double field);

    double relaxationTime() const { return relaxationTime_; }  ///< [s]; 0: no leakage
    double breakdownField() const { return breakdownField_; }  ///< [V/m]; 0: no limit
    bool active() const { return relaxationTime_ > 0 || breakdownField_ > 0; }

    /// New charge [C] of a particle after a step of that length [s]; books what it lost.
    double after(double charge, double radius, double timeStep, double permittivity);

    CompensatedSum& leaked() { return leaked_; }  ///< [C], this rank
    CompensatedSum& brokenDown() { return brokenDown_; }
    double& breakdowns() { return breakdowns_; }  ///< times that the limit acted
    const CompensatedSum& leaked() const { return leaked_; }
    const CompensatedSum& brokenDown() const { return brokenDown_; }
    double breakdowns() const { return breakdowns_; }

private:
    double relaxationTime_ = 0;
    double breakdownField_ = 0;
    CompensatedSum leaked_;
    CompensatedSum brokenDown_;
    double breakdowns_ = 0;
};

}  // namespace him
