// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/wall_contact_memory.hpp"

#include "electrostatics/constants.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace him;

WallTouch touch(double area, double degrees = 0, int wall = 0, int particle = 0)
{
    const double angle = degrees * pi / 180;
    return {particle, wall, area, {std::sin(angle), 0, -std::cos(angle)}};
}

class Memory : public testing::Test {
protected:
    Memory() { memory.resize(2); }

    /// Sum of the growth that a step with these touches gives.
    double step(const std::vector<WallTouch>& touches, Reloading reloading = Reloading::counted)
    {
        begun += memory.update(touches, 2, reloading, growing);
        double sum = 0;
        for (const GrowingWallContact& contact : growing) {
            sum += contact.growth;
        }
        return sum;
    }

    WallContactMemory memory{10};
    std::vector<GrowingWallContact> growing;
    std::int64_t begun = 0;
};

TEST_F(Memory, growthIsTheIncreaseOfTheAreaAndShrinkingGivesNone)
{
    EXPECT_DOUBLE_EQ(step({touch(3)}), 3);
    EXPECT_DOUBLE_EQ(step({touch(5)}), 2);
    EXPECT_DOUBLE_EQ(step({touch(4)}), 0);
    EXPECT_DOUBLE_EQ(step({touch(4.5)}), 0.5);
    EXPECT_EQ(begun, 1);
}

TEST_F(Memory, beyondMaximumCountsOnlyAreaThatTheContactNeverHad)
{
    step({touch(5)}, Reloading::beyondMaximum);
    step({touch(2)}, Reloading::beyondMaximum);
    EXPECT_DOUBLE_EQ(step({touch(4)}, Reloading::beyondMaximum), 0);
    EXPECT_DOUBLE_EQ(step({touch(6)}, Reloading::beyondMaximum), 1);
}

TEST_F(Memory, aContactThatEndedBeginsAnew)
{
    step({touch(5)});
    step({});
    EXPECT_DOUBLE_EQ(step({touch(5)}), 5);
    EXPECT_EQ(begun, 2);
}

TEST_F(Memory, facetsWithNearlyTheSameNormalAreOneContactWithTheLargestArea)
{
    EXPECT_DOUBLE_EQ(step({touch(2, 0), touch(3, 5.6)}), 3);
    EXPECT_EQ(begun, 1);
    EXPECT_NEAR(growing.at(0).normal[0], std::sin(5.6 * pi / 180), 1e-15);
}

TEST_F(Memory, facetsOfATrueEdgeAreTwoContacts)
{
    EXPECT_DOUBLE_EQ(step({touch(2, 0), touch(3, 60)}), 5);
    EXPECT_EQ(begun, 2);
}

TEST_F(Memory, aContactFollowsARollingBallAroundACurvedWall)
{
    step({touch(4, 0)});
    for (int facet = 1; facet < 60; ++facet) {
        EXPECT_DOUBLE_EQ(step({touch(4, 6.0 * facet)}), 0) << facet;
    }
    EXPECT_EQ(begun, 1);
}

TEST_F(Memory, wallsAndParticlesAreKeptApart)
{
    EXPECT_DOUBLE_EQ(step({touch(2, 0, 0, 0), touch(3, 0, 1, 0), touch(4, 0, 0, 1)}), 9);
    EXPECT_EQ(begun, 3);
    EXPECT_DOUBLE_EQ(step({touch(2, 0, 0, 0), touch(3, 0, 1, 0), touch(4, 0, 0, 1)}), 0);
}

TEST_F(Memory, aPackedRowContinuesElsewhereWithoutNewGrowth)
{
    step({touch(2, 0), touch(3, 60)});
    std::vector<double> buffer(memory.packedSize(0));
    EXPECT_EQ(memory.pack(0, buffer.data()), buffer.size());
    WallContactMemory other(10);
    other.resize(1);
    EXPECT_EQ(other.unpack(0, buffer.data()), buffer.size());
    EXPECT_EQ(other.update({touch(2, 0), touch(3, 60)}, 1, Reloading::counted, growing), 0);
    EXPECT_TRUE(growing.empty());
}

TEST_F(Memory, rowsThatAreFreedOrChangePlacesTakeTheirContactsAlong)
{
    step({touch(2, 0, 0, 1)});
    memory.copyRow(1, 0);
    memory.clearRow(1);
    EXPECT_DOUBLE_EQ(step({touch(2, 0, 0, 0), touch(5, 0, 0, 1)}), 5);
    memory.clearRow(0);
    EXPECT_DOUBLE_EQ(step({touch(2, 0, 0, 0), touch(5, 0, 0, 1)}), 2);
    EXPECT_EQ(growing.size(), 1);
    EXPECT_DOUBLE_EQ(step({touch(2, 0, 0, 0), touch(6, 0, 0, 1)}), 1);
    EXPECT_EQ(begun, 3);
}

TEST_F(Memory, growingContactsComeInTheOrderOfTheirRows)
{
    step({touch(2, 0, 0, 1)});
    step({touch(3, 0, 0, 1), touch(2, 0, 0, 0)});
    ASSERT_EQ(growing.size(), 2);
    EXPECT_EQ(growing[0].particle, 0);
    EXPECT_EQ(growing[1].particle, 1);
}

TEST(WallContactMemory, refusesAnAngleThatCanNotTellFacetsApart)
{
    EXPECT_THROW(WallContactMemory(0), std::invalid_argument);
    EXPECT_THROW(WallContactMemory(90), std::invalid_argument);
}

}  // namespace
