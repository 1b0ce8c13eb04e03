// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/projective_charging.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace him {

ChargeProjection::ChargeProjection(const Scalars& before, const Scalars& after, MPI_Comm communicator)
{
    if (before.size() != after.size()) {
        throw std::invalid_argument("a burst needs the charges of the same particles before and after it");
    }
    const Scalars gain = after - before;
    std::array<double, 3> sums{static_cast<double>(before.size()), before.sum(), gain.sum()};
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 3, MPI_DOUBLE, MPI_SUM, communicator);
    total_ = sums[2];
    if (sums[0] == 0) {
        return;
    }
    const double charge = sums[1] / sums[0];
    mean_ = c0_ = sums[2] / sums[0];
    std::array<double, 2> moments{(before - charge).square().sum(), ((before - charge) * gain).sum()};
    MPI_Allreduce(MPI_IN_PLACE, moments.data(), 2, MPI_DOUBLE, MPI_SUM, communicator);
    if (sums[0] >= 3 && moments[0] > 0) {
        c1_ = moments[1] / moments[0];
        c0_ = mean_ - c1_ * charge;
    }
}

Scalars ChargeProjection::project(const Scalars& charge, double bursts) const
{
    if (!(bursts >= 0)) {
        throw std::invalid_argument("a projection goes forward: its length must not be negative");
    }
    if (!relaxes()) {
        return charge + mean_ * bursts;
    }
    // q + (c0 + c1 q) (exp(c1 n) - 1)/c1
    return charge + (c0_ + c1_ * charge) * (std::expm1(c1_ * bursts) / c1_);
}

double ChargeProjection::wallFactor(const Scalars& charge, double bursts, MPI_Comm communicator) const
{
    double gained = (project(charge, bursts) - charge).sum();
    MPI_Allreduce(MPI_IN_PLACE, &gained, 1, MPI_DOUBLE, MPI_SUM, communicator);
    return total_ == 0 ? 0 : gained / total_;
}

double projectionError(double assumedGain, double foundGain)
{
    const double scale = std::max(std::fabs(assumedGain), std::fabs(foundGain));
    return scale == 0 ? 0 : std::fabs(foundGain - assumedGain) / scale;
}

}  // namespace him
