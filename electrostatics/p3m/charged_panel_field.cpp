// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/charged_panel.hpp"
#include "electrostatics/processor_clones.hpp"

#include <cmath>
#include <limits>

#if defined(__x86_64__) && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 35)
// The vector forms of these in libmvec, within 4 units of round-off. The C library's own headers mention them under -ffast-math only.
extern "C" {
__attribute__((simd("notinbranch"))) double log(double) noexcept;
__attribute__((simd("notinbranch"))) double atan2(double, double) noexcept;
}
#endif
#endif

namespace him {

namespace {

constexpr double smallest = std::numeric_limits<double>::min();

struct Corner {
    double x, y, z, distance;  ///< from the place to the corner, and its length
};

inline double dot(const Corner& a, const Corner& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline double dot(const Corner& a, const Vector3& b)
{
    return a.x * b[0] + a.y * b[1] + a.z * b[2];
}

/// Half the solid angle is the argument of this complex number, for a triangle with these corners.
struct HalfAngle {
    double real, imaginary;
};

inline HalfAngle halfAngle(const Corner& a, const Corner& b, const Corner& c)
{
    const double volume = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
    return {a.distance * b.distance * c.distance + dot(a, b) * c.distance + dot(b, c) * a.distance
                + dot(c, a) * b.distance,
            -volume};
}

/// Integral of 1/r along a side from `begin` to `end`.
inline double alongSide(const Corner& from, const Corner& to, const Vector3& along)
{
    const double begin = dot(from, along);
    const double end = dot(to, along);
    // Both forms are the same; the one that is taken loses no digits.
    const bool ahead = begin + end > 0;
    const double above = ahead ? to.distance + end : from.distance - begin;
    const double below = ahead ? from.distance + begin : to.distance - end;
    return log(above / below);
}

template <int corners>
__attribute__((always_inline)) inline void addFieldOf(const ChargedPanel& given, double factor, FieldAtPlaces& at)
{
    const ChargedPanel panel = given;  // a copy that no store below can change
    const double density = factor / panel.area;
    const auto places = static_cast<std::size_t>(at.places());
    for (std::size_t n = 0; n < places; ++n) {
        const auto cornerFrom = [&](std::size_t c) {
            const double x = panel.corner[c][0] - at.x[n];
            const double y = panel.corner[c][1] - at.y[n];
            const double z = panel.corner[c][2] - at.z[n];
            return Corner{x, y, z, std::sqrt(x * x + y * y + z * z)};
        };
        const Corner first = cornerFrom(0), second = cornerFrom(1), third = cornerFrom(2);
        double x = 0, y = 0, z = 0, sum = 0;
        const auto addSide = [&](std::size_t side, const Corner& from, const Corner& to) {
            const double integral = alongSide(from, to, panel.along[side]);
            x += integral * panel.outward[side][0];
            y += integral * panel.outward[side][1];
            z += integral * panel.outward[side][2];
            sum += dot(from, panel.outward[side]) * integral;
        };
        addSide(0, first, second);
        addSide(1, second, third);
        HalfAngle half = halfAngle(first, second, third);
        if constexpr (corners == 3) {
            addSide(2, third, first);
        } else {
            const Corner fourth = cornerFrom(3);
            addSide(2, third, fourth);
            addSide(3, fourth, first);
            // Half the solid angle of a flat panel is below pi: the argument of the product of its triangles' numbers.
            const HalfAngle other = halfAngle(first, third, fourth);
            half = {half.real * other.real - half.imaginary * other.imaginary,
                    half.real * other.imaginary + half.imaginary * other.real};
        }
        const double height = -dot(first, panel.normal);
        // Between 0 and pi, with the sign of the height. The vector form does not bear two zeros.
        const double argument = atan2(std::abs(half.imaginary) + smallest, half.real);
        const double angle = height > 0 ? 2 * argument : height < 0 ? -2 * argument : 0.0;
        at.fieldX[n] += density * (x + angle * panel.normal[0]);
        at.fieldY[n] += density * (y + angle * panel.normal[1]);
        at.fieldZ[n] += density * (z + angle * panel.normal[2]);
        at.potential[n] += density * (sum - height * angle);
    }
}

HIM_CLONES void addFieldOfTriangle(const ChargedPanel& panel, double factor, FieldAtPlaces& at)
{
    addFieldOf<3>(panel, factor, at);
}

HIM_CLONES void addFieldOfQuadrangle(const ChargedPanel& panel, double factor, FieldAtPlaces& at)
{
    addFieldOf<4>(panel, factor, at);
}

HIM_CLONES void addFieldOfPoint(const double* position, double charge, FieldAtPlaces& at)
{
    const double px = position[0], py = position[1], pz = position[2];
    const auto places = static_cast<std::size_t>(at.places());
    for (std::size_t n = 0; n < places; ++n) {
        const double x = at.x[n] - px;
        const double y = at.y[n] - py;
        const double z = at.z[n] - pz;
        const double square = x * x + y * y + z * z;
        const double potential = charge / std::sqrt(square);
        const double weight = potential / square;
        at.fieldX[n] += weight * x;
        at.fieldY[n] += weight * y;
        at.fieldZ[n] += weight * z;
        at.potential[n] += potential;
    }
}

}  // namespace

void ChargedPanel::addField(double factor, FieldAtPlaces& at) const
{
    if (corners == 3) {
        addFieldOfTriangle(*this, factor, at);
    } else {
        addFieldOfQuadrangle(*this, factor, at);
    }
}

void addFieldOfPoints(const std::vector<ChargedPanel::Point>& points, double factor, FieldAtPlaces& at)
{
    for (const ChargedPanel::Point& point : points) {
        addFieldOfPoint(point.position.data(), factor * point.share, at);
    }
}

}  // namespace him
