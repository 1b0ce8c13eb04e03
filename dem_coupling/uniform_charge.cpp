// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/uniform_charge.hpp"

#include "dem_coupling/charging/compensated_sum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace him {

UniformCharge replaceByMean(DemPort& dem, MPI_Comm communicator)
{
    DemParticles particles;
    dem.particles(particles);
    CompensatedSum charge, absolute;
    constexpr double lowest = std::numeric_limits<double>::lowest();
    std::array<double, 2> extremes{lowest, lowest};  // -smallest, largest
    for (const double q : particles.charge) {
        charge += q;
        absolute += std::fabs(q);
        extremes[0] = std::max(extremes[0], -q);
        extremes[1] = std::max(extremes[1], q);
    }
    std::array<double, 3> sums{static_cast<double>(particles.size()), charge.value(), absolute.value()};
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 3, MPI_DOUBLE, MPI_SUM, communicator);
    MPI_Allreduce(MPI_IN_PLACE, extremes.data(), 2, MPI_DOUBLE, MPI_MAX, communicator);

    UniformCharge result;
    result.particles = sums[0];
    result.before = result.after = sums[1];
    result.absolute = sums[2];
    if (sums[0] == 0) {
        return result;
    }
    result.replaced = extremes[1] != -extremes[0];
    result.mean = result.replaced ? sums[1] / sums[0] : extremes[1];
    if (result.replaced) {
        dem.setCharges(Scalars::Constant(particles.size(), result.mean));
        result.after = result.mean * sums[0];
    }
    return result;
}

}  // namespace him
