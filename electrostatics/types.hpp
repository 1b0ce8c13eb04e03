// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <limits>

namespace him {

using Index = Eigen::Index;

/// One scalar per particle or point.
using Scalars = Eigen::ArrayXd;

/// One vector per particle or point: N rows, columns x, y, z. Column-major, so that every component is contiguous and
/// the pair loops load whole SIMD registers.
using Points = Eigen::Array<double, Eigen::Dynamic, 3, Eigen::ColMajor>;

using Vector3 = Eigen::Vector3d;

/// Axis-aligned box [m]. A default box is empty and grows by extend().
struct Box {
    Vector3 lower = Vector3::Constant(std::numeric_limits<double>::max());
    Vector3 upper = Vector3::Constant(std::numeric_limits<double>::lowest());

    bool empty() const { return (lower.array() > upper.array()).any(); }
    Vector3 size() const { return upper - lower; }
    void extend(const Vector3& point)
    {
        lower = lower.cwiseMin(point);
        upper = upper.cwiseMax(point);
    }
    bool contains(const Vector3& point) const
    {
        return (point.array() >= lower.array()).all() && (point.array() <= upper.array()).all();
    }
    /// Square of the distance to the nearest point of the box, which must not be empty [m2].
    double squaredDistance(const Vector3& point) const
    {
        return (point - point.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
    }
    /// This box, larger by a margin [m] on every side.
    Box grownBy(double margin) const
    {
        Box grown = *this;
        if (!empty()) {
            grown.lower.array() -= margin;
            grown.upper.array() += margin;
        }
        return grown;
    }
    bool overlaps(const Box& other) const
    {
        return !empty() && !other.empty() && (lower.array() <= other.upper.array()).all()
               && (other.lower.array() <= upper.array()).all();
    }
};

}  // namespace him
