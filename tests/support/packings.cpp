// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/packings.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace him {

namespace {

// Lengths in diameters.

class Random {
public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}
    double unit() { return (static_cast<double>(generator_()) + 0.5) / 4294967296.0; }
    Vector3 in(const Box& box) { return box.lower + Vector3(unit(), unit(), unit()).cwiseProduct(box.size()); }

private:
    std::mt19937 generator_;  // its numbers are laid down by the standard, those of distributions are not
};

/// Points in cells of a little more than one diameter.
class CellList {
public:
    explicit CellList(double length) : cells_(std::max<Index>(1, static_cast<Index>(length / 1.01))), length_(length)
    {
        members_.resize(static_cast<std::size_t>(cells_ * cells_ * cells_));
    }
    void clear()
    {
        for (auto& cell : members_) {
            cell.clear();
        }
    }
    void add(const Vector3& point, Index row)
    {
        const auto cell = cellOf(point);
        members_[number(cell[0], cell[1], cell[2])].push_back(row);
    }
    /// Calls action(row) for every point in the cells around this one.
    template <class Action> void near(const Vector3& point, Action action) const
    {
        const auto cell = cellOf(point);
        for (Index x = std::max<Index>(cell[0] - 1, 0); x <= std::min(cell[0] + 1, cells_ - 1); ++x) {
            for (Index y = std::max<Index>(cell[1] - 1, 0); y <= std::min(cell[1] + 1, cells_ - 1); ++y) {
                for (Index z = std::max<Index>(cell[2] - 1, 0); z <= std::min(cell[2] + 1, cells_ - 1); ++z) {
                    for (const Index row : members_[number(x, y, z)]) {
                        action(row);
                    }
                }
            }
        }
    }

private:
    std::array<Index, 3> cellOf(const Vector3& point) const
    {
        std::array<Index, 3> cell;
        for (int axis = 0; axis < 3; ++axis) {
            cell[static_cast<std::size_t>(axis)] = std::clamp<Index>(
                static_cast<Index>(point[axis] / length_ * static_cast<double>(cells_)), 0, cells_ - 1);
        }
        return cell;
    }
    std::size_t number(Index x, Index y, Index z) const
    {
        return static_cast<std::size_t>(z + cells_ * (y + cells_ * x));
    }

    Index cells_;
    double length_;
    std::vector<std::vector<Index>> members_;
};

/// Places for sphere centres, one after the other, each wherever there is room.
class SequentialAddition {
public:
    SequentialAddition(double length, Random& random) : list_(length), random_(random) {}

    void add(Index count, const Box& region)
    {
        const Index goal = static_cast<Index>(places.size()) + count;
        for (Index attempt = 0; static_cast<Index>(places.size()) < goal; ++attempt) {
            if (attempt > 10000 * count) {
                throw std::runtime_error("makePacking: the spheres do not fit");
            }
            const Vector3 point = random_.in(region);
            bool free = true;
            list_.near(point, [&](Index other) {
                free = free && (places[static_cast<std::size_t>(other)] - point).squaredNorm() >= 1;
            });
            if (free) {
                list_.add(point, static_cast<Index>(places.size()));
                places.push_back(point);
            }
        }
    }

    std::vector<Vector3> places;

private:
    CellList list_;
    Random& random_;
};

Box boxOf(const Vector3& lower, const Vector3& upper)
{
    Box box;
    box.extend(lower);
    box.extend(upper);
    return box;
}

std::vector<Vector3> dilute(double length, Random& random)
{
    SequentialAddition addition(length, random);
    addition.add(std::lround(0.01 * std::pow(length, 3) * 6 / pi),
                 boxOf(Vector3::Constant(0.5), Vector3::Constant(length - 0.5)));
    return addition.places;
}

std::vector<Vector3> layer(double length, Random& random)
{
    SequentialAddition addition(length, random);
    const auto onEachWall = static_cast<Index>(0.4 * std::pow(length - 2, 2) * 4 / pi);
    for (int axis = 0; axis < 3; ++axis) {
        for (const double place : {0.5, length - 0.5}) {
            Vector3 lower = Vector3::Constant(1);
            Vector3 upper = Vector3::Constant(length - 1);
            lower[axis] = upper[axis] = place;
            addition.add(onEachWall, boxOf(lower, upper));
        }
    }
    return addition.places;
}

/// Pushes spheres that overlap apart until none does. Below random close packing this ends.
void separate(std::vector<Vector3>& places, const Box& region, double length)
{
    constexpr double distance = 1.0005;  // wanted; leaves room for what is left of the overlaps
    CellList list(length);
    for (int sweep = 0; sweep < 20000; ++sweep) {
        list.clear();
        for (std::size_t n = 0; n < places.size(); ++n) {
            list.add(places[n], static_cast<Index>(n));
        }
        double nearest = 1;
        for (std::size_t n = 0; n < places.size(); ++n) {
            list.near(places[n], [&](Index other) {
                const auto m = static_cast<std::size_t>(other);
                if (m <= n) {
                    return;
                }
                const Vector3 apart = places[n] - places[m];
                const double square = apart.squaredNorm();
                if (square < distance * distance && square > 0) {
                    const double gap = std::sqrt(square);
                    nearest = std::min(nearest, gap);
                    const Vector3 push = 0.5 * (distance - gap) / gap * apart;
                    places[n] = (places[n] + push).cwiseMax(region.lower).cwiseMin(region.upper);
                    places[m] = (places[m] - push).cwiseMax(region.lower).cwiseMin(region.upper);
                }
            });
        }
        if (nearest >= 1) {
            return;
        }
    }
    throw std::runtime_error("makePacking: the spheres do not fit");
}

std::vector<Vector3> bed(double length, Random& random)
{
    const Box region = boxOf(Vector3::Constant(0.5), Vector3(length - 0.5, length - 0.5, 0.5 * length - 0.5));
    std::vector<Vector3> places(static_cast<std::size_t>(std::lround(0.55 * std::pow(length, 3) / 2 * 6 / pi)));
    for (Vector3& place : places) {
        place = random.in(region);
    }
    separate(places, region, length);
    return places;
}

}  // namespace

Packing makePacking(Scene scene, double length, Signs signs, std::uint32_t seed, double diameter, double charge)
{
    Random random(seed);
    const std::vector<Vector3> places = scene == Scene::dilute ? dilute(length, random)
                                        : scene == Scene::bed  ? bed(length, random)
                                                               : layer(length, random);
    Packing packing;
    packing.box = boxOf(Vector3::Zero(), Vector3::Constant(length * diameter));
    packing.diameter = diameter;
    const auto count = static_cast<Index>(places.size());
    packing.position.resize(count, 3);
    packing.charge.resize(count);
    for (Index row = 0; row < count; ++row) {
        packing.position.row(row) = diameter * places[static_cast<std::size_t>(row)].transpose().array();
        packing.charge[row] = signs == Signs::random && random.unit() < 0.5 ? -charge : charge;
    }
    return packing;
}

}  // namespace him
