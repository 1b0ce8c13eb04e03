// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace him {

/// Running sum that keeps the rounding error of every addition (Neumaier), so that the books of a million steps close.
class CompensatedSum {
public:
    CompensatedSum() = default;
    explicit CompensatedSum(double value) : sum_(value) {}

    CompensatedSum& operator+=(double value)
    {
        const double next = sum_ + value;
        lost_ += std::fabs(sum_) >= std::fabs(value) ? (sum_ - next) + value : (value - next) + sum_;
        sum_ = next;
        return *this;
    }
    double value() const { return sum_ + lost_; }

private:
    double sum_ = 0;
    double lost_ = 0;
};

}  // namespace him
