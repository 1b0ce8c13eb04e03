// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charge_books.hpp"

#include "dem_coupling/charging/compensated_sum.hpp"

#include <algorithm>
#include <cmath>

namespace him {

void ChargeBooks::open(double particleCharge, double absoluteCharge, const ChargeMovements& earlier)
{
    opening_ = 0;
    scale_ = 0;
    post(particleCharge, absoluteCharge, earlier);
    opening_ = closureError();
}

void ChargeBooks::post(double particleCharge, double absoluteCharge, const ChargeMovements& movements)
{
    particleCharge_ = particleCharge;
    movements_ = movements;
    double moved = std::fabs(movements.inserted) + std::fabs(movements.removed) + std::fabs(movements.leaked)
                   + std::fabs(movements.breakdown);
    for (const double charge : movements.toWall) {
        moved += std::fabs(charge);
    }
    scale_ = std::max(scale_, absoluteCharge + moved);
}

double ChargeBooks::closureError() const
{
    CompensatedSum error(particleCharge_);
    error += -opening_;
    error += -movements_.inserted;
    error += movements_.removed;
    error += movements_.leaked;
    error += movements_.breakdown;
    for (const double charge : movements_.toWall) {
        error += charge;
    }
    return error.value();
}

double ChargeBooks::relativeClosureError() const
{
    return scale_ == 0 ? 0 : closureError() / scale_;
}

}  // namespace him
