// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/reference/grounded_box.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace him {
namespace {

constexpr double gaussian = 1 / (4 * pi);  ///< permittivity with which a unit charge makes a field of 1/r^2

Box boxOf(const Vector3& lower, const Vector3& upper)
{
    Box box;
    box.extend(lower);
    box.extend(upper);
    return box;
}

struct Charges {
    Points position;
    Scalars charge;
    Points field;
    Scalars potential;

    explicit Charges(const std::vector<std::array<double, 4>>& rows)
        : position(static_cast<Index>(rows.size()), 3), charge(static_cast<Index>(rows.size()))
    {
        for (Index row = 0; row < charge.size(); ++row) {
            const auto& [x, y, z, q] = rows[static_cast<std::size_t>(row)];
            position.row(row) << x, y, z;
            charge[row] = q;
        }
    }
    /// At random places in the box.
    Charges(Index count, const Box& box, std::uint32_t seed) : position(count, 3), charge(count)
    {
        std::mt19937 random(seed);
        const auto unit = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
        for (Index row = 0; row < count; ++row) {
            for (int axis = 0; axis < 3; ++axis) {
                position(row, axis) = box.lower[axis] + box.size()[axis] * unit();
            }
            charge[row] = 2 * unit() - 1;
        }
    }
    Charges& in(const GroundedBox& box)
    {
        box.compute(position, charge, field, potential);
        return *this;
    }
    double energy() const { return electrostaticEnergy(charge, potential); }
    double fieldScale() const { return std::sqrt(field.square().rowwise().sum().mean()); }
    double potentialScale() const { return std::sqrt(potential.square().mean()); }
};

/// Largest difference relative to the RMS.
double difference(const Charges& a, const Charges& b)
{
    return std::max((a.field - b.field).abs().maxCoeff() / b.fieldScale(),
                    (a.potential - b.potential).abs().maxCoeff() / b.potentialScale());
}

const Box shoeBox = boxOf({-0.3, 0.1, 2.0}, {0.7, 0.9, 2.5});

TEST(GroundedBox, pullsAChargeInACube)
{
    // In q^2/(4 pi eps L^2), computed independently from 8 alternating image lattices.
    const double side = 2e-3;
    const double charge = 3e-12;
    const Box cube = boxOf({1, 2, 3}, {1 + side, 2 + side, 3 + side});
    const double unit = charge / (4 * pi * epsilon0 * side * side);
    const GroundedBox box(cube, epsilon0);
    Charges nearWall({{1 + 0.25 * side, 2 + 0.5 * side, 3 + 0.5 * side, charge}});
    nearWall.in(box);
    EXPECT_NEAR(nearWall.field(0, 0), -3.09959 * unit, 5e-6 * unit);
    EXPECT_NEAR(nearWall.field(0, 1), 0, 1e-9 * unit);
    EXPECT_NEAR(nearWall.field(0, 2), 0, 1e-9 * unit);
    Charges nearCorner({{1 + 0.25 * side, 2 + 0.25 * side, 3 + 0.25 * side, charge}});
    nearCorner.in(box);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(nearCorner.field(0, axis), -1.91728 * unit, 5e-6 * unit);
    }
}

TEST(GroundedBox, givesTheImageForceNearAWall)
{
    const GroundedBox box(boxOf({0, 0, 0}, {40, 40, 40}), gaussian);
    for (const auto& [distance, expected] :
         {std::pair{0.01, -1.0000000}, std::pair{0.1, -0.9999997}, std::pair{0.5, -0.99996}}) {
        Charges one({{distance, 20, 20, 1}});
        one.in(box);
        EXPECT_NEAR(one.field(0, 0) * 4 * distance * distance, expected, distance < 0.3 ? 6e-8 : 6e-6) << distance;
        EXPECT_NEAR(one.potential[0] * 2 * distance, -1, 0.05 * distance);
    }
}

TEST(GroundedBox, doesNotDependOnTheSplitting)
{
    GroundedBox box(shoeBox, gaussian);
    box.setTolerance(1e-15);
    Charges reference(40, shoeBox, 1);
    box.setCutoff(0.3);
    reference.in(box);
    for (const double cutoff : {0.12, 0.5, 1.1, 2.5}) {
        box.setCutoff(cutoff);
        Charges other = reference;
        EXPECT_LT(difference(other.in(box), reference), 1e-12) << cutoff;
    }
    // With the default tolerance and the cutoff that it chooses itself.
    Charges chosen = reference;
    EXPECT_LT(difference(chosen.in(GroundedBox(shoeBox, gaussian)), reference), 1e-10);
}

/// Field of all octuplets of images with a shift of up to `shells` periods in each direction.
Points octuplets(const Charges& charges, const Box& box, int shells)
{
    const Index count = charges.charge.size();
    Points field = Points::Zero(count, 3);
    const Vector3 period = 2 * box.size();
    for (Index source = 0; source < count; ++source) {
        for (int a = -shells; a <= shells; ++a) {
            for (int b = -shells; b <= shells; ++b) {
                for (int c = -shells; c <= shells; ++c) {
                    for (int mirror = 0; mirror < 8; ++mirror) {
                        Vector3 image = charges.position.row(source).matrix().transpose() - box.lower;
                        double sign = charges.charge[source];
                        for (int axis = 0; axis < 3; ++axis) {
                            if (mirror >> axis & 1) {
                                image[axis] = -image[axis];
                                sign = -sign;
                            }
                        }
                        image += box.lower + period.cwiseProduct(Vector3(a, b, c));
                        const bool itself = a == 0 && b == 0 && c == 0 && mirror == 0;
                        for (Index row = 0; row < count; ++row) {
                            if (itself && row == source) {
                                continue;
                            }
                            const Vector3 r = charges.position.row(row).matrix().transpose() - image;
                            field.row(row) += (sign / std::pow(r.squaredNorm(), 1.5) * r).transpose().array();
                        }
                    }
                }
            }
        }
    }
    return field;
}

TEST(GroundedBox, equalsTheSumOverManyImages)
{
    Charges charges({{-0.2, 0.3, 2.1, 1}, {0.5, 0.8, 2.3, 1}, {0.1, 0.15, 2.45, -0.7}});
    charges.in(GroundedBox(shoeBox, gaussian));
    // The truncation of the image sum falls with the fourth power of the 17/2 and 51/2 periods, a ratio of 81: extrapolated.
    const Points coarse = octuplets(charges, shoeBox, 8);
    const Points fine = octuplets(charges, shoeBox, 25);
    const Points limit = fine + (fine - coarse) / 80;
    const auto error = [&](const Points& field) {
        return (field - charges.field).abs().maxCoeff() / charges.fieldScale();
    };
    EXPECT_LT(error(fine), 1e-8);
    EXPECT_NEAR(error(coarse) / error(fine), 81, 4);
    EXPECT_LT(error(limit), 1e-10);
}

TEST(GroundedBox, fieldIsTheSlopeOfTheEnergy)
{
    const GroundedBox box(shoeBox, gaussian);
    const Charges charges(12, shoeBox, 3);
    Charges middle = charges;
    middle.in(box);
    const double step = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
        // Moving a charge with its images: F = q E = -dU/dx.
        Charges up = charges;
        Charges down = charges;
        up.position(5, axis) += step;
        down.position(5, axis) -= step;
        const double slope = (up.in(box).energy() - down.in(box).energy()) / (2 * step);
        EXPECT_NEAR(slope, -charges.charge[5] * middle.field(5, axis), 1e-6 * middle.fieldScale());
    }
}

TEST(GroundedBox, fieldIsTheSlopeOfThePotentialAtAFreePoint)
{
    const GroundedBox box(shoeBox, gaussian);
    const Charges charges(12, shoeBox, 4);
    const double step = 1e-5;
    Points targets(7, 3);
    targets.rowwise() = Eigen::Array3d(0.21, 0.52, 2.24).transpose();
    for (int axis = 0; axis < 3; ++axis) {
        targets(1 + 2 * axis, axis) += step;
        targets(2 + 2 * axis, axis) -= step;
    }
    Points field;
    Scalars potential;
    box.computeAt(charges.position, charges.charge, targets, std::vector<Index>(7, -1), field, potential);
    for (int axis = 0; axis < 3; ++axis) {
        const double slope = (potential[1 + 2 * axis] - potential[2 + 2 * axis]) / (2 * step);
        EXPECT_NEAR(-slope, field(0, axis), 1e-6 * field.row(0).matrix().norm());
    }
    // And the potential vanishes on every side.
    Points walls(6, 3);
    walls.rowwise() = Eigen::Array3d(0.21, 0.52, 2.24).transpose();
    for (int axis = 0; axis < 3; ++axis) {
        walls(2 * axis, axis) = shoeBox.lower[axis];
        walls(2 * axis + 1, axis) = shoeBox.upper[axis];
    }
    Scalars onWalls;
    box.computeAt(charges.position, charges.charge, walls, std::vector<Index>(6, -1), field, onWalls);
    EXPECT_LT(onWalls.abs().maxCoeff(), 1e-10 * std::abs(potential[0]));
}

TEST(GroundedBox, isOddInTheCharges)
{
    const GroundedBox box(shoeBox, gaussian);
    Charges plus(30, shoeBox, 5);
    Charges minus = plus;
    minus.charge *= -1;
    plus.in(box);
    minus.in(box);
    EXPECT_EQ((plus.field + minus.field).abs().maxCoeff(), 0);
    EXPECT_EQ((plus.potential + minus.potential).abs().maxCoeff(), 0);
}

TEST(GroundedBox, givesASampleAndBlocksOfChargesAsTheWhole)
{
    const GroundedBox box(shoeBox, gaussian);
    Charges all(600, shoeBox, 6);  // more than one block of the mode sum
    all.in(box);
    const std::vector<Index> rows{5, 301, 599};
    const Points targets = all.position(rows, Eigen::all);
    Points field;
    Scalars potential;
    box.computeAt(all.position, all.charge, targets, rows, field, potential);
    EXPECT_LT((field - all.field(rows, Eigen::all)).abs().maxCoeff(), 1e-10 * all.fieldScale());
    EXPECT_LT((potential - all.potential(rows)).abs().maxCoeff(), 1e-10 * all.potentialScale());

    // Charges of two ranks add up at the same targets.
    const Points first = all.position.topRows(250);
    const Points second = all.position.bottomRows(350);
    Points fieldOfFirst;
    Scalars potentialOfFirst;
    box.computeAt(first, all.charge.head(250), targets, {5, -1, -1}, fieldOfFirst, potentialOfFirst);
    box.computeAt(second, all.charge.tail(350), targets, {-1, 51, 349}, field, potential);
    EXPECT_LT((fieldOfFirst + field - all.field(rows, Eigen::all)).abs().maxCoeff(), 1e-10 * all.fieldScale());
    EXPECT_LT((potentialOfFirst + potential - all.potential(rows)).abs().maxCoeff(), 1e-10 * all.potentialScale());
}

TEST(GroundedBox, hasInsulatedSides)
{
    // A cube whose lower x side insulates is half of a grounded box with the charges doubled at like sign.
    BoxSides half;
    half.lower[0] = BoxSide::insulated;
    const GroundedBox box(boxOf({0, 0, 0}, {1, 1, 1}), gaussian, half);
    const GroundedBox whole(boxOf({-1, 0, 0}, {1, 1, 1}), gaussian);
    Charges one({{0.2, 0.3, 0.6, 1}, {0.7, 0.5, 0.4, -2}});
    Charges doubled({{0.2, 0.3, 0.6, 1}, {0.7, 0.5, 0.4, -2}, {-0.2, 0.3, 0.6, 1}, {-0.7, 0.5, 0.4, -2}});
    one.in(box);
    doubled.in(whole);
    EXPECT_LT((one.field - doubled.field.topRows(2)).abs().maxCoeff(), 1e-10 * one.fieldScale());
    EXPECT_LT((one.potential - doubled.potential.head(2)).abs().maxCoeff(), 1e-10 * one.potentialScale());

    // Upper side insulated, which swaps sines for shifted sines.
    BoxSides mirrored;
    mirrored.upper[0] = BoxSide::insulated;
    Charges turned({{0.8, 0.3, 0.6, 1}, {0.3, 0.5, 0.4, -2}});
    turned.in(GroundedBox(boxOf({0, 0, 0}, {1, 1, 1}), gaussian, mirrored));
    EXPECT_NEAR(turned.field(0, 0), -one.field(0, 0), 1e-10 * one.fieldScale());
    EXPECT_NEAR(turned.field(1, 2), one.field(1, 2), 1e-10 * one.fieldScale());
}

TEST(GroundedBox, hasPeriodicSides)
{
    // Two periods of one box are the same as one box of twice the length.
    BoxSides sides;
    sides.lower[1] = sides.upper[1] = BoxSide::periodic;
    const GroundedBox single(boxOf({0, 0, 0}, {1, 1, 1}), gaussian, sides);
    const GroundedBox pair(boxOf({0, 0, 0}, {1, 2, 1}), gaussian, sides);
    Charges one({{0.2, 0.3, 0.6, 1}, {0.7, 0.9, 0.4, -2}});
    Charges two({{0.2, 0.3, 0.6, 1}, {0.7, 0.9, 0.4, -2}, {0.2, 1.3, 0.6, 1}, {0.7, 1.9, 0.4, -2}});
    one.in(single);
    two.in(pair);
    EXPECT_LT((one.field - two.field.topRows(2)).abs().maxCoeff(), 1e-10 * one.fieldScale());
    EXPECT_LT((one.potential - two.potential.head(2)).abs().maxCoeff(), 1e-10 * one.potentialScale());
}

TEST(GroundedBox, knowsTheMadelungConstantOfRockSalt)
{
    BoxSides sides;
    sides.lower.fill(BoxSide::periodic);
    sides.upper.fill(BoxSide::periodic);
    Charges salt(std::vector<std::array<double, 4>>{});
    salt.position.resize(8, 3);
    salt.charge.resize(8);
    for (int n = 0; n < 8; ++n) {
        salt.position.row(n) << (n & 1), (n >> 1 & 1), (n >> 2 & 1);
        salt.charge[n] = ((n & 1) + (n >> 1 & 1) + (n >> 2 & 1)) % 2 == 0 ? 1 : -1;
    }
    salt.position += 0.25;
    salt.in(GroundedBox(boxOf({0, 0, 0}, {2, 2, 2}), gaussian, sides));
    EXPECT_NEAR(salt.potential[0], -1.7475645946331822, 1e-10);
    // Nothing grounded and a net charge: a background takes it up, and the energy of one charge is Wigner's -2.837297/2.
    Charges lone({{0.3, 0.4, 0.5, 1}});
    lone.in(GroundedBox(boxOf({0, 0, 0}, {1, 1, 1}), gaussian, sides));
    EXPECT_NEAR(lone.potential[0], -2.837297479, 1e-8);
}

TEST(GroundedBox, refusesWhatItCannotSum)
{
    const GroundedBox box(boxOf({0, 0, 0}, {1, 1, 1}), gaussian);
    EXPECT_EQ(refusal([&] {
                  Charges({{0.5, 0.5, 1.5, 1}}).in(box);
              }),
              "the position of row 0, (0.5 0.5 1.5) m, is not inside the box from (0 0 0) m to (1 1 1) m");
    EXPECT_EQ(
        refusal([&] {
            Charges({{0.5, 0.5, 0.5, 1}, {0.5, 0.5, 0.5, 2}}).in(box);
        }),
        "target 0 at (0.5 0.5 0.5) m from the corner of the box shares the position of charge 1; its field would be "
        "infinite");
    EXPECT_EQ(refusal([&] {
                  Charges({{0.5, 0.5, 0.0, 1}}).in(box);
              }),
              "target 0 at (0.5 0.5 0) m from the corner of the box meets an image of charge 0; its field would be "
              "infinite");
    EXPECT_EQ(refusal([&] {
                  Charges({{0.5, std::nan(""), 0.0, 1}}).in(box);
              }),
              "the position of row 0 must be finite (at most 1e+50), found nan");
    EXPECT_EQ(refusal([&] { GroundedBox(Box{}, gaussian); }), "each side of the box must be > 0 and finite, found 0");
    BoxSides sides;
    sides.lower[2] = BoxSide::periodic;
    EXPECT_EQ(refusal([&] {
                  GroundedBox(boxOf({0, 0, 0}, {1, 1, 1}), gaussian, sides);
              }),
              "a box is periodic on both sides of a direction or on none");
}

TEST(GroundedBox, handlesNothing)
{
    Charges none(std::vector<std::array<double, 4>>{});
    none.in(GroundedBox(shoeBox, gaussian));
    EXPECT_EQ(none.field.rows(), 0);
}

}  // namespace
}  // namespace him
