// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"

#include "settings/checkedDictionary.H"

#include <algorithm>

namespace him {

void checkUniformCharge(const caseSettings& settings, DemPort& dem, MPI_Comm communicator, Complaints& complaints)
{
    if (!settings.fixedUniformCharge) {
        return;
    }
    const std::string where = "constant/couplingProperties: fixedUniformCharge";
    dem.chargeParticles();
    DemParticles particles;
    dem.particles(particles);
    double largest = particles.size() > 0 ? particles.charge.abs().maxCoeff() : 0;
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
    if (largest == 0) {
        complaints.add(where, "no particle has a charge, so there is no mean to give. Continue from a time at which the particles are "
                              "charged (startFrom latestTime, and a script that reads the checkpoint of that time).");
    }
    if (dem.losesCharge()) {
        complaints.add(where, "it holds all charges, but fix charge/gran/contact lets them leak or break down. Take `relaxationTime` and "
                              "`breakdownField` out of the script, or write fixedUniformCharge no.");
    }
}

void checkProjectiveCharging(const caseSettings& settings, const DemPort& dem, Complaints& complaints)
{
    if (!settings.projectiveCharging.active) {
        return;
    }
    const std::string where = "constant/couplingProperties: projectiveCharging";
    if (!dem.charging()) {
        complaints.add(where, "the DEM script has no fix charge/gran/contact, so nothing charges. Add it, or take the entry out.");
    }
    if (dem.chargingAcceleration() != 1) {
        complaints.add(where, "its bursts are true charging, but the script has acceleration " + shown(dem.chargingAcceleration())
                                  + ". Take `acceleration` out of fix charge/gran/contact; leap makes the charging faster.");
    }
    if (dem.losesCharge()) {
        complaints.add(where, "it projects what contacts move, but fix charge/gran/contact lets charge leak or break down, too. Take "
                              "`relaxationTime` and `breakdownField` out of the script, or projectiveCharging out of the case.");
    }
}

}  // namespace him
