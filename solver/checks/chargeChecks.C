// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"

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

}  // namespace him
