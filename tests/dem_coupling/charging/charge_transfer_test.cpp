// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charge_transfer.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace {

using namespace him;

constexpr double radius = 1e-3;

/// Particles on one rank, with their held fields.
struct Scene {
    explicit Scene(int n) : tag(n), type(n, 1), size(n, radius), charge(n, 0.0), held(n)
    {
        std::iota(tag.begin(), tag.end(), 1);
        for (int i = 0; i < n; ++i) {
            held[i].fill(0);
        }
    }
    DemRows rows(bool withField = false)
    {
        DemRows rows;
        rows.local = rows.all = static_cast<int>(tag.size());
        rows.tag = tag.data();
        rows.type = type.data();
        rows.radius = size.data();
        rows.charge = charge.data();
        rows.held.first = withField ? held[0].data() : nullptr;
        return rows;
    }
    double total() const { return std::accumulate(charge.begin(), charge.end(), 0.0); }

    std::vector<int> tag, type;
    std::vector<double> size, charge;
    std::vector<std::array<double, HeldField::width>> held;
};

ChargeTransfer law(double kappaPair, double gammaWall = 0, double kappaWall = 0)
{
    ChargingPairs pairs(2);
    pairs.set(1, 1, 0, kappaPair);
    pairs.set(1, 2, gammaWall, kappaWall);
    ChargeTransfer transfer(pairs, epsilon0);
    transfer.setWalls({2}, {1});
    return transfer;
}

void step(ChargeTransfer& transfer, Scene& scene, const std::vector<GrowingPair>& pairs,
          const std::vector<GrowingWallContact>& walls = {}, bool withField = false)
{
    transfer.sumRelaxations(scene.rows(withField), pairs, walls);
    transfer.move(scene.rows(withField), pairs, walls);
}

/// Growth dA that gives the relaxation number x at kappa 1.
double growthFor(double x)
{
    return x * 4 * pi * radius * radius;
}

std::vector<GrowingPair> star(double x, unsigned seed)
{
    std::vector<GrowingPair> contacts;
    for (int arm = 1; arm <= 12; ++arm) {
        if (arm % 2) {
            contacts.push_back({0, arm, growthFor(x), {1, 0, 0}});
        } else {
            contacts.push_back({arm, 0, growthFor(x), {-1, 0, 0}});
        }
    }
    std::shuffle(contacts.begin(), contacts.end(), std::mt19937(seed));
    return contacts;
}

class Star : public testing::TestWithParam<double> {};

TEST_P(Star, ofTwelveContactsNeverPassesTheCommonMeanInOneStepOrMany)
{
    Scene scene(13);
    scene.charge[0] = 1e-10;
    const double mean = 1e-10 / 13;
    ChargeTransfer transfer = law(1);
    double last = scene.charge[0];
    for (int repeat = 0; repeat < 5; ++repeat) {
        step(transfer, scene, star(GetParam(), 7));
        EXPECT_LE(scene.charge[0], last * (1 + 1e-14));
        EXPECT_GE(scene.charge[0], mean * (1 - 1e-12));
        for (int arm = 1; arm <= 12; ++arm) {
            EXPECT_LE(scene.charge[arm], mean * (1 + 1e-12));
            EXPECT_GE(scene.charge[arm], 0);
        }
        EXPECT_NEAR(scene.total() / 1e-10, 1, 1e-14);
        last = scene.charge[0];
    }
}

TEST_P(Star, doesNotDependOnTheOrderOfItsContacts)
{
    Scene one(13), other(13);
    one.charge[0] = other.charge[0] = 1e-10;
    one.charge[3] = other.charge[3] = -4e-11;
    ChargeTransfer transfer = law(1);
    step(transfer, one, star(GetParam(), 1));
    step(transfer, other, star(GetParam(), 2));
    for (int i = 0; i < 13; ++i) {
        EXPECT_NEAR(one.charge[i], other.charge[i], 1e-24) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(ChargeTransfer, Star, testing::Values(1e-3, 1.0, 50.0));

TEST(ChargeTransfer, twelveContactsAtFiftyReachTheCommonMeanOfEachContactShare)
{
    // x = 50 everywhere: M = 13 x, so each arm takes x/(13 x) of the difference: the common mean exactly (to exp(-650)).
    Scene scene(13);
    scene.charge[0] = 1e-10;
    ChargeTransfer transfer = law(1);
    step(transfer, scene, star(50, 3));
    for (const double charge : scene.charge) {
        EXPECT_NEAR(charge / (1e-10 / 13), 1, 1e-12);
    }
}

TEST(ChargeTransfer, aContactCutIntoSubStepsMovesTheSameCharge)
{
    // Exact for an isolated contact (physics: updated law), so 1, 7 and 1000 pieces agree.
    for (const int pieces : {7, 1000}) {
        Scene whole(2), cut(2);
        whole.charge[0] = cut.charge[0] = 2.548e-11;
        ChargeTransfer transfer = law(1, -2e6, 1);
        step(transfer, whole, {{0, 1, growthFor(0.7), {1, 0, 0}}});
        for (int piece = 0; piece < pieces; ++piece) {
            step(transfer, cut, {{0, 1, growthFor(0.7 / pieces), {1, 0, 0}}});
        }
        EXPECT_NEAR(cut.charge[1] / whole.charge[1], 1, 1e-12) << pieces;

        Scene wallWhole(1), wallCut(1);
        step(transfer, wallWhole, {}, {{0, 0, growthFor(0.7), {0, 0, -1}}});
        for (int piece = 0; piece < pieces; ++piece) {
            step(transfer, wallCut, {}, {{0, 0, growthFor(0.7 / pieces), {0, 0, -1}}});
        }
        EXPECT_NEAR(wallCut.charge[0] / wallWhole.charge[0], 1, 1e-12) << pieces;
    }
}

TEST(ChargeTransfer, anIsolatedPairFollowsTheUpdatedLaw)
{
    Scene scene(2);
    scene.charge[0] = 1e-10;
    ChargeTransfer transfer = law(1);
    const double x = 0.3;
    step(transfer, scene, {{0, 1, growthFor(x), {1, 0, 0}}});
    // Equal spheres: the difference decays as exp(-2 x).
    EXPECT_NEAR((scene.charge[0] - scene.charge[1]) / 1e-10, std::exp(-2 * x), 1e-14);
}

TEST(ChargeTransfer, aParticleBetweenTwoWallsStopsAtSaturation)
{
    Scene scene(1);
    ChargeTransfer transfer = law(0, -2e6, 1);
    step(transfer, scene, {}, {{0, 0, growthFor(40), {0, 0, -1}}, {0, 0, growthFor(90), {0, 1, 0}}});
    EXPECT_NEAR(scene.charge[0] / saturationCharge(-2e6, radius, epsilon0), 1, 1e-14);
    EXPECT_NEAR(transfer.toWall()[0].value() / scene.charge[0], -1, 1e-15);
}

TEST(ChargeTransfer, aWallWithoutTransferGivesNothing)
{
    Scene scene(1);
    ChargeTransfer transfer = law(0, -2e6, 1);
    transfer.setWalls({2}, {0});
    step(transfer, scene, {}, {{0, 0, growthFor(1), {0, 0, -1}}});
    EXPECT_EQ(scene.charge[0], 0);
}

TEST(ChargeTransfer, flippingGammaFieldAndAllChargesFlipsEveryChargeToTheBit)
{
    Scene plus(3), minus(3);
    plus.charge = {3e-11, -1e-11, 5e-12};
    minus.charge = {-3e-11, 1e-11, -5e-12};
    for (int i = 0; i < 3; ++i) {
        plus.held[i] = {1e4 * i, -3e4, 2e4, 2.1e-3 * i, 1e-5 * i, 0, plus.charge[i]};
        minus.held[i] = {-1e4 * i, 3e4, -2e4, 2.1e-3 * i, 1e-5 * i, 0, minus.charge[i]};
    }
    const std::vector<GrowingPair> pairs{{0, 1, growthFor(0.1), {0.8, 0.6, 0}}, {1, 2, growthFor(0.4), {0.6, 0.8, 0}}};
    const std::vector<GrowingWallContact> walls{{0, 0, growthFor(0.2), {0, 0, -1}}};
    ChargeTransfer up = law(1, 5e5, 3), down = law(1, -5e5, 3);
    step(up, plus, pairs, walls, true);
    step(down, minus, pairs, walls, true);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(plus.charge[i], -minus.charge[i]) << i;
    }
}

/// Held fields of two touching particles of radii a and b and a third charge far away, by Coulomb's law.
struct TouchingPair {
    TouchingPair(double a, double b) : scene(2)
    {
        scene.size = {a, b};
        scene.charge = {4e-11, -7e-11};
        const std::array<std::array<double, 3>, 2> place{{{0, 0, 0}, {0.6 * (a + b), 0.8 * (a + b), 0}}};
        for (int i = 0; i < 2; ++i) {
            std::array<double, 3> field = coulomb(place[i], third, thirdCharge);
            const std::array<double, 3> partner = coulomb(place[i], place[1 - i], scene.charge[1 - i]);
            for (int d = 0; d < 3; ++d) {
                scene.held[i][d] = field[d] + partner[d];
                scene.held[i][3 + d] = place[i][d];
            }
            scene.held[i][6] = scene.charge[i];
        }
        for (int d = 0; d < 3; ++d) {
            contact[d] = place[0][d] + (place[1][d] - place[0][d]) * a / (a + b);
        }
    }
    static std::array<double, 3> coulomb(const std::array<double, 3>& at, const std::array<double, 3>& from,
                                         double charge)
    {
        std::array<double, 3> apart{};
        double square = 0;
        for (int d = 0; d < 3; ++d) {
            apart[d] = at[d] - from[d];
            square += apart[d] * apart[d];
        }
        for (double& component : apart) {
            component *= charge / (4 * pi * epsilon0 * square * std::sqrt(square));
        }
        return apart;
    }
    /// Charge that the first particle gains, without relaxation, divided by eps kappa dA, less the two own fields.
    double measuredDrive(double partnerCutoff = std::numeric_limits<double>::infinity())
    {
        ChargeTransfer transfer = law(1);
        transfer.setPartnerCutoff(partnerCutoff);
        const double growth = 1e-11;  // x below 1e-6: no relaxation to speak of
        const std::vector<double> before = scene.charge;
        step(transfer, scene, {{0, 1, growth, {0.6, 0.8, 0}}}, {}, true);
        const double own =
            -surfaceField(before[0], scene.size[0], epsilon0) + surfaceField(before[1], scene.size[1], epsilon0);
        const double gained = scene.charge[0] - before[0];
        scene.charge = before;
        return gained / (epsilon0 * growth) - own;
    }

    const std::array<double, 3> third{0.3, -0.2, 0.1};
    const double thirdCharge = 5e-6;
    Scene scene;
    std::array<double, 3> contact{};
};

TEST(ChargeTransfer, fieldOfTheOthersAtATouchingPairIsThatOfADistantThirdCharge)
{
    // Radii 1:1 and 1:3: the swapped weights of S2.23 as printed would only survive the first.
    for (const double ratio : {1.0, 3.0}) {
        TouchingPair pair(1e-3, ratio * 1e-3);
        const auto exact = TouchingPair::coulomb(pair.contact, pair.third, pair.thirdCharge);
        const double along = exact[0] * 0.6 + exact[1] * 0.8;
        // Interpolation error is second order in size over distance: (4e-3/0.37)^2.
        EXPECT_NEAR(pair.measuredDrive() / -along, 1, 2e-4) << "radii 1:" << ratio;
    }
}

TEST(ChargeTransfer, aPartnerBeyondTheCutoffOfTheFieldIsNotTakenOut)
{
    TouchingPair pair(1e-3, 1e-3);
    EXPECT_GT(std::fabs(pair.measuredDrive(1.9e-3) / pair.measuredDrive(2.1e-3) - 1), 0.1);
}

TEST(ChargeTransfer, wallContactFieldSelfIgnoresTheFieldOfTheOthersAndTotalSeesIt)
{
    for (const WallContactField field : {WallContactField::self, WallContactField::total}) {
        Scene scene(1);
        scene.held[0] = {0, 0, 3e5, 0, 0, 0, 0};
        ChargeTransfer transfer = law(0, -1e6, 1);
        transfer.setWallContactField(field);
        step(transfer, scene, {}, {{0, 0, growthFor(50), {0, 0, -1}}}, true);
        // Field along +z is -3e5 along the normal into the floor; drive Gamma - E.n.
        const double gamma = field == WallContactField::self ? -1e6 : -1e6 + 3e5;
        EXPECT_NEAR(scene.charge[0] / saturationCharge(gamma, radius, epsilon0), 1, 1e-12);
    }
}

TEST(Walls, keepWhatRoundingKeepsFromAParticleSoThatTheBooksCloseOverAMillionStepsAtSaturation)
{
    // At saturation the drive is a rounding error of one sign, and each gain is below the last digit of the charge.
    for (const double gamma : {-8.03e5, -8.41e5, 7.66e5, -1.52e6, 3.3e5}) {
        Scene scene(1);
        scene.size[0] = 5.555e-3;
        ChargeTransfer transfer = law(0, gamma, 20);
        const std::vector<GrowingWallContact> wall = {{0, 0, 2e-7, {0, 0, -1}}};
        for (int n = 0; n < 1000000; ++n) {
            step(transfer, scene, {}, wall);
        }
        const double saturation = saturationCharge(gamma, scene.size[0], epsilon0);
        EXPECT_NEAR(scene.charge[0] / saturation, 1, 1e-12);
        EXPECT_LE(std::abs(scene.charge[0] + transfer.toWall()[0].value()), 1e-15 * std::abs(saturation)) << gamma;
    }
}

}  // namespace
