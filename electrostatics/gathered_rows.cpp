// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/gathered_rows.hpp"

#include "electrostatics/processor_clones.hpp"

#include <algorithm>

namespace him {

namespace {

constexpr float farAway = 1000.0F;  ///< in cutoffs

HIM_CLONES void offsets(const double* from, double place, double perLength, Index count, float* to)
{
    for (Index n = 0; n < count; ++n) {
        to[n] = static_cast<float>((from[n] - place) * perLength);
    }
}

HIM_CLONES void add(const float* what, Index count, float* to)
{
    for (Index n = 0; n < count; ++n) {
        to[n] += what[n];
    }
}

}  // namespace

void SingleRows::start(const double* charges, Index rows, double unit, Index targets)
{
    charge.resize(static_cast<std::size_t>(rows));
    for (Index row = 0; row < rows; ++row) {
        charge[static_cast<std::size_t>(row)] = static_cast<float>(charges[row] / unit);
    }
    for (std::vector<float>* values : {&fieldX, &fieldY, &fieldZ, &potential}) {
        values->assign(static_cast<std::size_t>(targets), 0.0F);
    }
}

void GatheredRows::begin(Index rows, int ranges, const Vector3& place, double length)
{
    place_ = place;
    perLength_ = 1.0 / length;
    size_ = 0;
    const auto room = static_cast<std::size_t>(rows + ranges * singlePadding);
    if (x_.size() < room) {
        for (std::vector<float>* values : {&x_, &y_, &z_, &q_, &fieldX_, &fieldY_, &fieldZ_, &potential_}) {
            values->resize(room + room / 4);
        }
    }
}

void GatheredRows::append(const RowRange& range, const PointArrays& points, const float* charge)
{
    const Index count = range.end - range.begin;
    offsets(points.x + range.begin, place_.x(), perLength_, count, x_.data() + size_);
    offsets(points.y + range.begin, place_.y(), perLength_, count, y_.data() + size_);
    offsets(points.z + range.begin, place_.z(), perLength_, count, z_.data() + size_);
    std::copy(charge + range.begin, charge + range.end, q_.data() + size_);
    size_ += count;
}

void GatheredRows::pad()
{
    std::fill_n(x_.begin() + size_, singlePadding, farAway);
    for (std::vector<float>* values : {&y_, &z_, &q_}) {
        std::fill_n(values->begin() + size_, singlePadding, 0.0F);
    }
    size_ += singlePadding;
}

GatheredPoints GatheredRows::finish(Index summed)
{
    for (std::vector<float>* values : {&fieldX_, &fieldY_, &fieldZ_, &potential_}) {
        std::fill_n(values->begin(), summed, 0.0F);
    }
    return {x_.data(),      y_.data(),      z_.data(),      q_.data(),
            fieldX_.data(), fieldY_.data(), fieldZ_.data(), potential_.data()};
}

void GatheredRows::addTo(const RowRange& range, Index row, SingleRows& sums) const
{
    const Index count = range.end - range.begin;
    add(fieldX_.data() + row, count, sums.fieldX.data() + range.begin);
    add(fieldY_.data() + row, count, sums.fieldY.data() + range.begin);
    add(fieldZ_.data() + row, count, sums.fieldZ.data() + range.begin);
    add(potential_.data() + row, count, sums.potential.data() + range.begin);
}

}  // namespace him
