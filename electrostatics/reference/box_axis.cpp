// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/reference/box_axis.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace him {

BoxAxis::BoxAxis(double length, BoxSide lower, BoxSide upper) : length_(length), lower_(lower), upper_(upper)
{
    if ((lower == BoxSide::periodic) != (upper == BoxSide::periodic)) {
        throw std::invalid_argument("a box is periodic on both sides of a direction or on none");
    }
}

void BoxAxis::images(double position, double margin, std::vector<Image>& list) const
{
    list.assign(1, {position, 1.0, 1.0});
    const bool periodic = lower_ == BoxSide::periodic;
    const double atLower = lower_ == BoxSide::grounded ? -1 : 1;
    const double atUpper = upper_ == BoxSide::grounded ? -1 : 1;
    const double period = periodic ? length_ : 2 * length_;
    const auto periods = static_cast<int>(margin / period) + 1;
    for (int n = -periods; n <= periods; ++n) {
        // Two reflections, one at each end, make one period.
        const double sign = n % 2 == 0 ? 1 : atLower * atUpper;
        const auto add = [&](const Image& image) {
            if (image.position >= -margin && image.position <= length_ + margin) {
                list.push_back(image);
            }
        };
        if (n != 0) {
            add({position + n * period, 1, sign});
        }
        if (!periodic) {
            add({-position + n * period, -1, sign * atLower});
        }
    }
}

// Grounded at both ends: sin((n + 1) pi x/L); insulated at both: cos(n pi x/L); one of each: (n + 1/2) pi x/L, sine from a
// grounded lower end, cosine from an insulated one; periodic: 1, then cosine and sine of 2 pi n x/L in turn.

double BoxAxis::waveNumber(Index mode) const
{
    if (lower_ == BoxSide::periodic) {
        return 2 * pi / length_ * static_cast<double>((mode + 1) / 2);
    }
    const double ends = (lower_ == BoxSide::grounded ? 0.5 : 0.0) + (upper_ == BoxSide::grounded ? 0.5 : 0.0);
    return pi / length_ * (static_cast<double>(mode) + ends);
}

Index BoxAxis::modesUpTo(double largest) const
{
    if (std::isless(largest, waveNumber(0))) {
        return 0;
    }
    auto modes = static_cast<Index>(largest * length_ / pi) + 2;
    while (modes > 0 && waveNumber(modes - 1) > largest) {
        --modes;
    }
    return modes;
}

void BoxAxis::evaluate(const Eigen::Ref<const Scalars>& position, Index modes, Eigen::MatrixXd& value,
                       Eigen::MatrixXd& derivative) const
{
    value.resize(modes, position.size());
    derivative.resize(modes, position.size());
    const bool periodic = lower_ == BoxSide::periodic;
    const bool sine = lower_ == BoxSide::grounded;
    const double step = (periodic ? 2 : 1) * pi / length_;
    const double scale = std::sqrt(2 / length_);
    for (Index column = 0; column < position.size(); ++column) {
        const double x = position[column];
        const double stepCos = std::cos(step * x);
        const double stepSin = std::sin(step * x);
        const double first = periodic ? 0 : waveNumber(0);
        double c = std::cos(first * x);
        double s = std::sin(first * x);
        // Rotation by one step at a time: its error grows linearly with the number of the mode.
        const auto turn = [&] {
            const double turned = c * stepCos - s * stepSin;
            s = s * stepCos + c * stepSin;
            c = turned;
        };
        for (Index mode = 0; mode < modes; ++mode) {
            const double k = waveNumber(mode);
            const bool constant = k == 0;
            const double norm = constant ? std::sqrt(1 / length_) : scale;
            const bool isSine = periodic ? mode % 2 == 0 && mode > 0 : sine;
            if (periodic && mode % 2 == 1) {
                turn();
            }
            value(mode, column) = norm * (isSine ? s : c);
            derivative(mode, column) = norm * k * (isSine ? c : -s);
            if (!periodic) {
                turn();
            }
        }
    }
}

}  // namespace him
