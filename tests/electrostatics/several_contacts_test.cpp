// SPDX-License-Identifier: GPL-3.0-or-later
// Several contacts in the same step: the shared factor of chargeGained.
#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace him {
namespace {

constexpr int wall = -1;

struct Contact {
    int a;
    int b;  // or wall
    double areaGrowth;
    double transferLimit;
};

struct Bed {
    std::vector<double> radius;
    std::vector<double> charge;
    double efficiency = 1.0;

    double numberOf(int i, const Contact& c) const { return relaxationNumber(efficiency, c.areaGrowth, radius[i]); }

    /// Charges after one step in which all contacts grow. What walls gain is returned.
    double step(const std::vector<Contact>& contacts)
    {
        std::vector<double> sum(radius.size(), 0.0);
        for (const Contact& c : contacts) {
            sum[c.a] += numberOf(c.a, c);
            if (c.b != wall) {
                sum[c.b] += numberOf(c.b, c);
            }
        }
        std::vector<double> gained(radius.size(), 0.0);
        double wallGained = 0.0;
        for (const Contact& c : contacts) {
            ContactDrive drive{c.transferLimit, surfaceField(charge[c.a], radius[c.a], epsilon0), 0.0, 0.0};
            double relaxation = sum[c.a];
            if (c.b != wall) {
                drive.surfaceFieldB = surfaceField(charge[c.b], radius[c.b], epsilon0);
                relaxation = pairRelaxation(sum[c.a], sum[c.b], numberOf(c.a, c), numberOf(c.b, c));
            }
            const double dq = chargeGained(drive, relaxation, efficiency, c.areaGrowth, epsilon0);
            gained[c.a] += dq;
            (c.b == wall ? wallGained : gained[c.b]) -= dq;
        }
        for (std::size_t i = 0; i < charge.size(); ++i) {
            charge[i] += gained[i];
        }
        return wallGained;
    }
};

Bed starBed()
{
    Bed bed;
    bed.radius.assign(13, 1e-3);
    bed.charge.assign(13, 0.0);
    bed.charge[0] = 1e-10;
    return bed;
}

std::vector<Contact> starContacts(double x)
{
    std::vector<Contact> contacts;
    for (int i = 1; i <= 12; ++i) {
        contacts.push_back({0, i, x * 4.0 * pi * 1e-6, 0.0});
    }
    return contacts;
}

class Star : public testing::TestWithParam<double> {};

TEST_P(Star, ofTwelveContactsDoesNotOvershootTheCommonMean)
{
    const double x = GetParam();
    Bed bed = starBed();
    bed.step(starContacts(x));
    const double mean = 1e-10 / 13.0;
    EXPECT_GE(bed.charge[0], mean * (1.0 - 1e-14));
    EXPECT_LT(bed.charge[0], 1e-10);
    for (int i = 1; i <= 12; ++i) {
        EXPECT_GT(bed.charge[i], 0.0);
        EXPECT_LE(bed.charge[i], mean * (1.0 + 1e-14));
    }
    EXPECT_NEAR(bed.charge[0], mean + (1e-10 - mean) * std::exp(-13.0 * x), 1e-23);
}

TEST_P(Star, doesNotDependOnTheOrderOfTheContacts)
{
    std::vector<Contact> contacts = starContacts(GetParam());
    for (int i = 0; i < 12; ++i) {
        contacts[i].areaGrowth *= 1.0 + 0.1 * i;
        contacts[i].transferLimit = 1e3 * (i - 4);
    }
    Bed first = starBed();
    first.step(contacts);
    std::mt19937 random(7);
    for (int shuffle = 0; shuffle < 20; ++shuffle) {
        std::shuffle(contacts.begin(), contacts.end(), random);
        Bed other = starBed();
        other.step(contacts);
        for (std::size_t i = 0; i < first.charge.size(); ++i) {
            EXPECT_NEAR(other.charge[i], first.charge[i], 1e-24);
        }
    }
}

TEST_P(Star, ofWallContactsEndsAtSaturation)
{
    const double x = GetParam();
    const double saturation = -3e-10;
    std::vector<Contact> contacts;
    for (int i = 0; i < 12; ++i) {
        contacts.push_back({0, wall, x * 4.0 * pi * 1e-6, surfaceField(saturation, 1e-3, epsilon0)});
    }
    Bed bed = starBed();
    const double wallGained = bed.step(contacts);
    EXPECT_NEAR(bed.charge[0], saturation + (1e-10 - saturation) * std::exp(-12.0 * x), 1e-23);
    EXPECT_NEAR(wallGained + bed.charge[0], 1e-10, 1e-24);
}

INSTANTIATE_TEST_SUITE_P(WeakToStrong, Star, testing::Values(1e-3, 1.0, 50.0));

TEST(SeveralContacts, inARandomBedConserveChargeAndNeverLeaveTheRangeOfSurfaceFields)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> size(0.5e-3, 2e-3);
    std::uniform_real_distribution<double> sign(-1.0, 1.0);
    std::uniform_int_distribution<int> pick(0, 39);
    Bed bed;
    for (int i = 0; i < 40; ++i) {
        bed.radius.push_back(size(random));
        bed.charge.push_back(1e-10 * sign(random));
    }
    const double total = std::accumulate(bed.charge.begin(), bed.charge.end(), 0.0);
    const auto largestField = [&bed] {
        double largest = 0.0;
        for (std::size_t i = 0; i < bed.charge.size(); ++i) {
            largest = std::max(largest, std::abs(surfaceField(bed.charge[i], bed.radius[i], epsilon0)));
        }
        return largest;
    };
    double largest = largestField();
    for (int step = 0; step < 200; ++step) {
        std::vector<Contact> contacts;
        while (contacts.size() < 120) {
            const int a = pick(random);
            const int b = pick(random);
            if (a != b) {
                contacts.push_back({a, b, 1e-4 * std::abs(sign(random)), 0.0});
            }
        }
        bed.step(contacts);
        // Without a drive the surface fields can only even out.
        EXPECT_LE(largestField(), largest * (1.0 + 1e-13));
        largest = largestField();
    }
    EXPECT_NEAR(std::accumulate(bed.charge.begin(), bed.charge.end(), 0.0), total, 1e-12 * 40 * 1e-10);
}

}  // namespace
}  // namespace him
