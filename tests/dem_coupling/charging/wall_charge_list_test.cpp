// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/wall_charge_list.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using namespace him;

class List : public testing::Test {
protected:
    static constexpr double radius = 1e-4;

    List()
    {
        for (std::size_t row = 0; row < rows; ++row) {
            place[row] = {static_cast<double>(row) * 1e-3, 0, radius};
            centres[row] = place[row].data();
            radii[row] = radius;
        }
    }
    /// A gain at the floor below a particle.
    static ChargeTransfer::WallGain gain(int particle, double charge, int wall = 0)
    {
        return {particle, wall, {0, 0, -1}, charge};
    }
    void step(const std::vector<ChargeTransfer::WallGain>& gains) { list.add(gains, centres.data(), radii.data()); }
    std::vector<WallCharge> taken()
    {
        std::vector<WallCharge> out;
        list.take(out);
        return out;
    }

    static constexpr std::size_t rows = 4;
    std::array<std::array<double, 3>, rows> place{};
    std::array<double*, rows> centres{};
    std::array<double, rows> radii{};
    WallChargeList list;
};

TEST_F(List, aContactThatGrowsThroughSeveralStepsIsOneEntryWithAllItsCharge)
{
    step({gain(0, 1), gain(2, 10)});
    step({gain(0, 2), gain(1, 100), gain(2, 20)});
    step({gain(1, 200), gain(2, 30)});
    const std::vector<WallCharge> all = taken();
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].charge, 3);
    EXPECT_EQ(all[1].charge, 60);
    EXPECT_EQ(all[2].charge, 300);
    EXPECT_TRUE(all[1].point.isApprox(Vector3(2e-3, 0, 0), 1e-15));
}

TEST_F(List, aContactThatHasMovedAwayFromItsEntryBeginsANewOne)
{
    step({gain(0, 1)});
    place[0][0] += 0.9 * WallChargeList::samePoint * radius;
    step({gain(0, 2)});
    place[0][0] += 0.2 * WallChargeList::samePoint * radius;
    step({gain(0, 4)});
    const std::vector<WallCharge> all = taken();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].charge, 3);
    EXPECT_EQ(all[1].charge, 4);
    EXPECT_EQ(all[1].point[0], place[0][0]);
}

TEST_F(List, aParticleInACornerHasAnEntryForEachWall)
{
    step({gain(0, 1, 0), {0, 1, {-1, 0, 0}, 10}, {0, 0, {-1, 0, 0}, 100}});
    step({gain(0, 2, 0), {0, 1, {-1, 0, 0}, 20}, {0, 0, {-1, 0, 0}, 200}});
    const std::vector<WallCharge> all = taken();
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].charge, 3);
    EXPECT_EQ(all[1].charge, 30);
    EXPECT_EQ(all[1].wall, 1);
    EXPECT_EQ(all[2].charge, 300);
}

TEST_F(List, nothingIsAddedToWhatWasTakenNorToTheContactOfAnotherParticleInTheSameRow)
{
    step({gain(0, 1)});
    EXPECT_EQ(taken().size(), 1U);
    step({gain(0, 2)});
    list.separate();
    step({gain(0, 4)});
    const std::vector<WallCharge> all = taken();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].charge, 2);
    EXPECT_EQ(all[1].charge, 4);
    EXPECT_TRUE(taken().empty());
}

TEST_F(List, gainsOutOfOrderLoseNoCharge)
{
    step({gain(3, 1), gain(0, 2)});
    step({gain(0, 4), gain(3, 8)});
    double sum = 0;
    for (const WallCharge& entry : taken()) {
        sum += entry.charge;
    }
    EXPECT_EQ(sum, 15);
}

}  // namespace
