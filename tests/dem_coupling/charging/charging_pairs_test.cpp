// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charging_pairs.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using him::ChargingPairs;

std::string refusal(const std::function<void(ChargingPairs&)>& wrong)
{
    ChargingPairs pairs(3);
    pairs.set(1, 3, -1e6, 2);
    try {
        wrong(pairs);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ChargingPairs, gammaChangesSignWithTheOrderOfTheTypesAndKappaDoesNot)
{
    ChargingPairs pairs(2);
    pairs.set(1, 2, -7.67e5, 20);
    EXPECT_EQ(pairs.of(1, 2).transferLimit, -7.67e5);
    EXPECT_EQ(pairs.of(2, 1).transferLimit, 7.67e5);
    EXPECT_EQ(pairs.of(2, 1).efficiency, 20);
    EXPECT_TRUE(pairs.of(2, 1).transfers);
    EXPECT_FALSE(pairs.of(1, 1).given);
}

TEST(ChargingPairs, refusesWhatCanNotBeMeant)
{
    using Pairs = ChargingPairs&;
    EXPECT_EQ(refusal([](Pairs p) { p.set(1, 4, 0, 1); }), "pair 1 4: there is no type 4; the box has types 1 to 3");
    EXPECT_EQ(refusal([](Pairs p) { p.set(1, 2, 0, -1); }),
              "pair 1 2: kappa must be a finite number >= 0, found -1.000000");
    EXPECT_EQ(refusal([](Pairs p) { p.set(1, 1, 5, 1); }),
              "pair 1 1: gamma must be 0 between equal types, because Gamma_ij = -Gamma_ji");
    EXPECT_EQ(refusal([](Pairs p) { p.set(3, 1, 0, 1); }),
              "pair 3 1 is given twice (a pair holds for both orders; Gamma changes sign by itself)");
    EXPECT_EQ(refusal([](Pairs p) { p.setNone(1, 3); }),
              "pair 1 3 is given twice (a pair holds for both orders; Gamma changes sign by itself)");
    EXPECT_EQ(refusal([](Pairs p) { p.set(1, 2, std::numeric_limits<double>::infinity(), 1); }),
              "pair 1 2: gamma must be a finite number [V/m]");
}

TEST(ChargingPairs, everyPairThatCanTouchAndWasNotGivenIsNamedOnce)
{
    ChargingPairs pairs(4);
    pairs.set(1, 1, 0, 3600);
    pairs.set(1, 3, -1e6, 20);
    pairs.setNone(2, 3);
    him::Complaints complaints;
    pairs.complainAboutMissing({1, 2}, {3, 4}, "in.bed: fix tribo", complaints);
    ASSERT_EQ(complaints.lines().size(), 4u);  // 1-2, 2-2, 1-4, 2-4; walls never touch walls
    EXPECT_EQ(
        complaints.lines()[0],
        "in.bed: fix tribo: Gamma and kappa are missing for types 1 and 2, which can touch. Add 'pair 1 2 gamma <V/m> "
        "kappa <->', or 'pair 1 2 none' for no charge transfer.");
}

}  // namespace
