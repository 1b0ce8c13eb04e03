// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "tests/electrostatics/pair_sums.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

struct Sums {
    Points field;
    Scalars potential;
    std::int64_t pairs = 0;

    explicit Sums(Index targets) : field(Points::Zero(targets, 3)), potential(Scalars::Zero(targets)) {}
};

TEST(AllPairs, equalTheCellListAtALargeCutoff)
{
    const ChargedPoints points = clusteredPoints(600, 31);
    Sums all(600);
    all.pairs = addAllPairs(points.position, points.position, points.charge, 0, epsilon0, all.field, all.potential);
    PairSumResult near;
    NearField(100.0, epsilon0).coulomb(points, near);
    const BruteForce scale = bruteForce(points, 100.0, epsilon0, false);
    EXPECT_EQ(all.pairs, 600 * 599);
    EXPECT_EQ(all.pairs, near.pairs);
    for (Index i = 0; i < 600; ++i) {
        EXPECT_LE((all.field.row(i) - near.field.row(i)).matrix().norm(), 1e-13 * scale.fieldScale[i]);
        EXPECT_NEAR(all.potential[i], near.potential[i], 1e-13 * scale.potentialScale[i]);
    }
}

TEST(AllPairs, addUpOverBlocksOfSourcesAsRanksSendThem)
{
    const ChargedPoints points = randomPoints(97, 1.0, 1.0, 1.0, 32);
    Sums whole(97);
    addAllPairs(points.position, points.position, points.charge, 0, epsilon0, whole.field, whole.potential);

    const Index cut = 40;
    const Points lower = points.position.topRows(cut);
    const Points upper = points.position.bottomRows(97 - cut);
    Sums part(97 - cut);
    part.pairs = addAllPairs(upper, lower, points.charge.head(cut), -1, epsilon0, part.field, part.potential);
    part.pairs += addAllPairs(upper, upper, points.charge.tail(97 - cut), 0, epsilon0, part.field, part.potential);
    EXPECT_EQ(part.pairs, 57 * 96);

    Sums offset(97 - cut);
    offset.pairs = addAllPairs(upper, points.position, points.charge, cut, epsilon0, offset.field, offset.potential);
    EXPECT_EQ(offset.pairs, 57 * 96);
    const BruteForce scale = bruteForce(points, 100.0, epsilon0, false);
    for (Index i = 0; i < 97 - cut; ++i) {
        EXPECT_LE((part.field.row(i) - whole.field.row(cut + i)).matrix().norm(), 1e-13 * scale.fieldScale[cut + i]);
        EXPECT_LE((offset.field.row(i) - whole.field.row(cut + i)).matrix().norm(), 1e-13 * scale.fieldScale[cut + i]);
        EXPECT_NEAR(part.potential[i], whole.potential[cut + i], 1e-13 * scale.potentialScale[cut + i]);
    }
}

TEST(AllPairs, handleNoTargetsAndNoSources)
{
    const ChargedPoints points = randomPoints(3, 1.0, 1.0, 1.0, 33);
    const Points none(0, 3);
    Sums nothing(0);
    EXPECT_EQ(addAllPairs(none, points.position, points.charge, -1, epsilon0, nothing.field, nothing.potential), 0);
    Sums three(3);
    EXPECT_EQ(addAllPairs(points.position, none, Scalars(0), -1, epsilon0, three.field, three.potential), 0);
    EXPECT_EQ(three.field.abs().maxCoeff(), 0.0);
}

TEST(AllPairs, energyOfTwoChargesIsCoulombs)
{
    ChargedPoints points = randomPoints(2, 0.0, 0.0, 0.0, 34);
    points.position(1, 2) = 0.02;
    points.charge << 3e-9, -5e-9;
    Sums sums(2);
    addAllPairs(points.position, points.position, points.charge, 0, epsilon0, sums.field, sums.potential);
    const double expected = -15e-18 / (4.0 * pi * epsilon0 * 0.02);
    EXPECT_NEAR(electrostaticEnergy(points.charge, sums.potential), expected, 1e-14 * std::abs(expected));
}

TEST(AllPairs, refuseOnePositionHeldTwice)
{
    ChargedPoints points = randomPoints(9, 1.0, 1.0, 1.0, 35);
    points.position.row(2) << 1.0, 2.0, 3.0;
    points.position.row(6) = points.position.row(2);
    Sums sums(9);
    EXPECT_EQ(refusal([&] {
                  addAllPairs(points.position, points.position, points.charge, 0, epsilon0, sums.field, sums.potential);
              }),
              "rows 2 and 6 share the position (1 2 3) m; their field would be infinite");
    const Points target = points.position.row(6);
    Sums one(1);
    points.position.row(6).setZero();
    EXPECT_EQ(
        refusal([&] { addAllPairs(target, points.position, points.charge, -1, epsilon0, one.field, one.potential); }),
        "target row 0 and source row 2 share the position (1 2 3) m; their field would be infinite");
}

TEST(AllPairs, refuseWhatDoesNotFit)
{
    ChargedPoints points = randomPoints(4, 1.0, 1.0, 1.0, 36);
    Sums sums(4);
    const std::string lengths =
        "addAllPairs: the lengths of targets, sources, charges, field and potential do not match";
    EXPECT_EQ(refusal([&] {
                  addAllPairs(points.position, points.position, Scalars(3), 0, epsilon0, sums.field, sums.potential);
              }),
              lengths);
    EXPECT_EQ(refusal([&] {
                  addAllPairs(points.position, points.position, points.charge, 1, epsilon0, sums.field, sums.potential);
              }),
              lengths);
    points.position(1, 1) = std::nan("");
    EXPECT_EQ(refusal([&] {
                  addAllPairs(points.position, points.position, points.charge, 0, epsilon0, sums.field, sums.potential);
              }),
              "the position of row 1 must be finite (at most 1e+50), found nan");
    EXPECT_EQ(refusal([] { electrostaticEnergy(Scalars(2), Scalars(3)); }),
              "electrostaticEnergy: charge and potential differ in length");
}

}  // namespace
}  // namespace him
