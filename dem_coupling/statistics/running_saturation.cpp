// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/statistics/running_saturation.hpp"

namespace him {

void RunningSaturation::add(double chargingTime, double value)
{
    if (!(chargingTime > 0)) {
        return;
    }
    if (offered_ % stride_ == 0) {
        times_.push_back(chargingTime);
        values_.push_back(value);
        if (times_.size() == mostValues) {
            for (std::size_t n = 0; 2 * n < mostValues; ++n) {
                times_[n] = times_[2 * n];
                values_[n] = values_[2 * n];
            }
            times_.resize(mostValues / 2);
            values_.resize(mostValues / 2);
            stride_ *= 2;
        }
    }
    if (++offered_ >= nextFit_) {
        curve_ = fitSaturationCurve(times_, values_);
        nextFit_ = offered_ + offered_ / 20 + 1;
    }
}

}  // namespace him
