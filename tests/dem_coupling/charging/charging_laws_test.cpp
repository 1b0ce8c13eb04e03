// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the pairs, spread over particles, losses, initial charges, frozen charges and the own image.
#include "dem_coupling/charging/charge_losses.hpp"
#include "dem_coupling/charging/charge_transfer.hpp"
#include "dem_coupling/charging/initial_charge.hpp"
#include "electrostatics/constants.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace {

using namespace him;

constexpr double radius = 1e-3;

double growthFor(double x)
{
    return x * 4 * pi * radius * radius;
}

std::string refusal(const std::function<void()>& wrong)
{
    try {
        wrong();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

/// Two particles of type 1 and 2, tags 1 and 2, and a wall of type 3.
struct Bodies {
    std::array<int, 2> tag{1, 2};
    std::array<int, 2> type{1, 2};
    std::array<double, 2> size{radius, 2 * radius};
    std::array<double, 2> charge{0, 0};
    std::array<std::array<double, HeldField::width>, 2> held{};

    DemRows rows(bool withField)
    {
        DemRows rows;
        rows.local = rows.all = 2;
        rows.tag = tag.data();
        rows.type = type.data();
        rows.radius = size.data();
        rows.charge = charge.data();
        rows.held.first = withField ? held[0].data() : nullptr;
        return rows;
    }
    void step(ChargeTransfer& transfer, const std::vector<GrowingPair>& pairs, const std::vector<GrowingWallContact>& walls,
              bool withField = false)
    {
        transfer.setWalls({3}, {1});
        transfer.sumRelaxations(rows(withField), pairs, walls);
        transfer.move(rows(withField), pairs, walls);
    }
};

/// Saturates the first particle at the wall.
double saturatedAtWall(ChargeTransfer& transfer, Bodies& bodies)
{
    bodies.step(transfer, {}, {{0, 0, growthFor(200), {0, 0, -1}}});
    return bodies.charge[0];
}

TEST(ChargingLaws, saturationAtAWallEndsAtTheChargeThatWasGiven)
{
    ChargingPairs pairs(3);
    pairs.setAtWall(1, 3, saturationOfSphere(-6.57e-10, 1.59e-3), 1);
    ChargeTransfer transfer(pairs, epsilon0);
    Bodies bodies;
    bodies.size[0] = 1.59e-3;
    EXPECT_NEAR(saturatedAtWall(transfer, bodies) / -6.57e-10, 1, 1e-12);
}

TEST(ChargingLaws, saturationChargeOfAPairDoesNotDependOnThePermittivityThatComesLater)
{
    ChargingPairs pairs(3);
    pairs.setAtWall(3, 1, saturationOfSphere(6.57e-10, 1.59e-3), 1);  // the wall leads: particle gets the opposite
    ChargeTransfer transfer(pairs, epsilon0);
    transfer.setPermittivity(3 * epsilon0);
    Bodies bodies;
    bodies.size[0] = 1.59e-3;
    EXPECT_NEAR(saturatedAtWall(transfer, bodies) / -6.57e-10, 1, 1e-12);
}

TEST(ChargingLaws, aSizeLawChargesEverySizeToItsOwnSaturation)
{
    // R Table 5 by its smallest and largest sphere: -0.4276 nC at 3.18 mm, -2.757 nC at 11.11 mm (diameters).
    const double potential = (-1.52e6 + 8.03e5) / (1 / 1.59e-3 - 1 / 5.555e-3);
    const SaturationLaw law{epsilon0 * (-1.52e6 - potential / 1.59e-3), potential};
    for (const auto& [size, charge] : {std::pair{1.59e-3, -0.4276e-9}, std::pair{5.555e-3, -2.757e-9}}) {
        ChargingPairs pairs(3);
        pairs.setSaturation(1, law);
        pairs.setFromSaturations(1, 3, 1);
        ChargeTransfer transfer(pairs, epsilon0);
        Bodies bodies;
        bodies.size[0] = size;
        bodies.step(transfer, {}, {{0, 0, 60 * 4 * pi * size * size, {0, 0, -1}}});
        EXPECT_NEAR(bodies.charge[0] / charge, 1, 2e-4);
    }
}

TEST(ChargingLaws, spheresOfTwoMaterialsInContactFollowR18WithTheirOwnSizes)
{
    ChargingPairs pairs(3);
    const SaturationLaw one{-4e-6, -300}, other{-1e-6, 100};
    pairs.setSaturation(1, one);
    pairs.setSaturation(2, other);
    pairs.setFromSaturations(2, 1, 1);
    ChargeTransfer transfer(pairs, epsilon0);
    Bodies bodies;
    const double growth = 1e-14;  // no relaxation to speak of
    bodies.step(transfer, {{0, 1, growth, {1, 0, 0}}}, {});
    const double gamma = transferLimitOfSpheres(one, radius, other, 2 * radius, epsilon0);
    EXPECT_NEAR(bodies.charge[0] / (epsilon0 * growth * gamma), 1, 1e-6);
    EXPECT_EQ(bodies.charge[1], -bodies.charge[0]);
}

TEST(ChargingLaws, spheresOfOneMaterialAndTwoSizesChargeOppositelyUnderASizeLaw)
{
    ChargingPairs pairs(3);
    pairs.setSaturation(1, {-4e-6, -300});
    pairs.setFromSaturations(1, 1, 1);
    ChargeTransfer transfer(pairs, epsilon0);
    Bodies bodies;
    bodies.type = {1, 1};
    bodies.step(transfer, {{0, 1, 1e-12, {1, 0, 0}}}, {});
    EXPECT_LT(bodies.charge[0], 0);  // the small one has the more negative Gamma
    EXPECT_EQ(bodies.charge[1], -bodies.charge[0]);
}

TEST(ChargingLaws, theHigherWorkFunctionChargesNegatively)
{
    ChargingPairs pairs(3);
    pairs.setWorkFunction(1, 4.5 * elementaryCharge);
    pairs.setWorkFunction(3, 4.3 * elementaryCharge);
    pairs.setFromWorkFunctions(1, 3, 1);
    ChargeTransfer transfer(pairs, epsilon0);
    Bodies bodies;
    EXPECT_NEAR(saturatedAtWall(transfer, bodies) / saturationCharge(-0.2 / 500e-9, radius, epsilon0), 1, 1e-12);
}

TEST(ChargingLaws, softeningAndAccelerationMultiplyTheRateAndNotTheLimit)
{
    ChargingPairs pairs(3);
    pairs.set(1, 3, -1e6, 4);
    pairs.setSoftening(1, 3, 0.0331);
    pairs.setAcceleration(10);
    ChargeTransfer transfer(pairs, epsilon0);
    EXPECT_NEAR(transfer.pairs().of(1, 3).rate, 4 * 0.0331 * 10, 1e-15);
    EXPECT_EQ(transfer.pairs().of(3, 1).rate, transfer.pairs().of(1, 3).rate);
    Bodies bodies;
    bodies.step(transfer, {}, {{0, 0, growthFor(0.3), {0, 0, -1}}});
    const double saturation = saturationCharge(-1e6, radius, epsilon0);
    EXPECT_NEAR(bodies.charge[0] / (saturation * -std::expm1(-0.3 * 4 * 0.331)), 1, 1e-12);
}

TEST(ChargingLaws, spreadHasItsMeanAndDeviationAndBelongsToTheTag)
{
    const ParticleSpread spread{2e5, 42};
    double sum = 0, squares = 0;
    const int particles = 200000;
    for (int tag = 1; tag <= particles; ++tag) {
        sum += spread.of(tag);
        squares += spread.of(tag) * spread.of(tag);
    }
    EXPECT_NEAR(sum / particles, 0, 4 * 2e5 / std::sqrt(particles));
    EXPECT_NEAR(std::sqrt(squares / particles) / 2e5, 1, 4 / std::sqrt(2.0 * particles));
    EXPECT_EQ(spread.of(17), (ParticleSpread{2e5, 42}.of(17)));
    EXPECT_NE(spread.of(17), (ParticleSpread{2e5, 43}.of(17)));
    EXPECT_EQ((ParticleSpread{0, 42}.of(17)), 0);
}

TEST(ChargingLaws, spreadShiftsTheSaturationOfEachParticleByItsOwnNumberAndStaysConserving)
{
    ChargingPairs pairs(3);
    pairs.set(1, 3, -1e6, 1);
    pairs.set(1, 2, 0, 1);
    const ParticleSpread one{3e5, 7}, other{2e5, 8};
    pairs.setSpread(1, one);
    pairs.setSpread(2, other);
    ChargeTransfer transfer(pairs, epsilon0);
    Bodies bodies;
    EXPECT_NEAR(saturatedAtWall(transfer, bodies) / saturationCharge(-1e6 + one.of(1), radius, epsilon0), 1, 1e-12);
    bodies.charge = {0, 0};
    const double growth = 1e-14;
    bodies.step(transfer, {{1, 0, growth, {-1, 0, 0}}}, {});
    EXPECT_NEAR(bodies.charge[0] / (epsilon0 * growth * (one.of(1) - other.of(2))), 1, 1e-6);
    EXPECT_EQ(bodies.charge[0], -bodies.charge[1]);
}

TEST(ChargingLaws, checkNamesWhatALawIsMissingAndWhatNobodyUses)
{
    ChargingPairs pairs(3);
    pairs.setFromWorkFunctions(1, 3, 1);
    pairs.setWorkFunction(3, 7e-19);
    pairs.setFromSaturations(2, 3, 1);
    pairs.setSaturation(1, {1e-6, 0});
    const Complaints complaints = pairs.check();
    ASSERT_EQ(complaints.lines().size(), 3u);
    EXPECT_EQ(complaints.lines()[0],
              "pair 1 3: type 1 has no work function. Add 'workFunction 1 <J>' or 'workFunctionEV 1 <eV>'");
    EXPECT_EQ(complaints.lines()[1].substr(0, 46), "pair 2 3: neither type has a saturation. Add '");
    EXPECT_EQ(complaints.lines()[2],
              "type 1: its saturation is used by no pair. Write 'pair <I> <J> saturation kappa <->'");
}

TEST(ChargingLaws, refuseNumbersThatCanNotBeMeant)
{
    ChargingPairs pairs(2);
    EXPECT_EQ(refusal([&] { pairs.setWorkFunction(1, 4.5); }),
              "work function of type 1 is 4.5 J, more than 600 eV, and those of solids are a few eV. Write electron volts with "
              "'workFunctionEV', joules with 'workFunction'");
    EXPECT_EQ(refusal([&] { pairs.setWorkFunction(1, -1e-19); }),
              "work function of type 1 must be a number above zero, found -1e-19 J");
    EXPECT_EQ(refusal([&] { pairs.setWorkFunction(3, 1e-19); }), "work function: there is no type 3; the box has types 1 to 2");
    EXPECT_EQ(refusal([&] { pairs.setAcceleration(0); }), "acceleration must be a number above zero");
    EXPECT_EQ(refusal([&] { pairs.setSeparation(-1); }), "deltaE must be a length above zero [m]");
    EXPECT_EQ(refusal([&] { pairs.setSpread(1, {-1, 0}); }),
              "spread of type 1: the standard deviation must be a number >= 0");
    EXPECT_NE(refusal([&] { pairs.setAtWall(1, 1, {1e-6, 0}, 1); }).find("a type does not saturate at itself"), std::string::npos);
    ChargeLosses losses;
    EXPECT_EQ(refusal([&] { losses.setRelaxationTime(0); }), "relaxationTime [s] must be > 0 and finite, found 0");
    EXPECT_EQ(refusal([&] { losses.setBreakdownField(-3e6); }), "breakdownField [V/m] must be > 0 and finite, found -3e+06");
}

// ---------------------------------------------------------------------- frozen, own image, own response

TEST(FrozenCharges, moveTheirShareOfTheDistanceToSaturationHoweverTheContactIsCut)
{
    // physics: frozen gives x (q_sat - q_0), updated (1 - exp(-x))(q_sat - q_0).
    ChargingPairs pairs(3);
    pairs.set(1, 3, -1e6, 1);
    const double saturation = saturationCharge(-1e6, radius, epsilon0);
    for (const int pieces : {1, 7, 1000}) {
        ChargeTransfer transfer(pairs, epsilon0);
        transfer.setUpdate(WithinContact::frozen);
        Bodies bodies;
        bodies.charge[0] = 0.2 * saturation;
        double moved = 0;
        for (int piece = 1; piece <= pieces; ++piece) {
            const double growth = growthFor(0.3 / pieces);
            bodies.step(transfer, {}, {{0, 0, growth, {0, 0, -1}, piece * growth, &moved}});
        }
        EXPECT_NEAR(bodies.charge[0] / saturation, 0.2 + 0.3 * 0.8, 1e-12) << pieces;
        EXPECT_NEAR(moved / saturation, 0.3 * 0.8, 1e-12);
        EXPECT_EQ(transfer.strongFrozenContacts(), 0);
    }
}

TEST(FrozenCharges, ofAPairAt3600SwapWhenXIsAQuarterOfIt)
{
    // Equal spheres, x = 1: frozen moves the whole difference (a swap), updated (1 - exp(-2))/2 = 43 % of it.
    for (const int pieces : {1, 50}) {
        ChargingPairs pairs(3);
        pairs.set(1, 1, 0, 1);
        ChargeTransfer transfer(pairs, epsilon0);
        transfer.setUpdate(WithinContact::frozen);
        Bodies bodies;
        bodies.type = {1, 1};
        bodies.size = {radius, radius};
        bodies.charge = {1e-10, 3e-11};
        double moved = 0;
        for (int piece = 1; piece <= pieces; ++piece) {
            const double growth = growthFor(1.0 / pieces);
            // The second particle's row comes first; `moved` still counts towards the lower tag.
            bodies.step(transfer, {{1, 0, growth, {-1, 0, 0}, piece * growth, &moved}}, {});
        }
        EXPECT_NEAR(bodies.charge[0] / 3e-11, 1, 1e-12);
        EXPECT_NEAR(bodies.charge[1] / 1e-10, 1, 1e-12);
        EXPECT_EQ(transfer.strongFrozenContacts(), 1);
    }
}

TEST(OwnImage, atTheTouchingWallHalvesTheSaturationCharge)
{
    ChargingPairs pairs(3);
    pairs.set(1, 3, -1e6, 1);
    ChargeTransfer transfer(pairs, epsilon0);
    transfer.setOwnImage(true);
    Bodies bodies;
    const double saturation = saturationCharge(-1e6, radius, epsilon0);
    EXPECT_NEAR(saturatedAtWall(transfer, bodies) / saturation, 0.5, 1e-12);
    // and the approach is that of twice the relaxation number, exactly, in one step or many
    for (const int pieces : {1, 100}) {
        bodies.charge = {0, 0};
        for (int piece = 0; piece < pieces; ++piece) {
            bodies.step(transfer, {}, {{0, 0, growthFor(0.3 / pieces), {0, 0, -1}}});
        }
        EXPECT_NEAR(bodies.charge[0] / saturation, -0.5 * std::expm1(-0.6), 1e-12);
    }
}

TEST(OwnResponse, isTakenOutOfTheFieldAtAWallAndStaysInThePairContact)
{
    ChargingPairs pairs(3);
    pairs.set(1, 3, -1e6, 1);
    pairs.set(1, 2, 0, 1);
    ChargeTransfer transfer(pairs, epsilon0);
    transfer.setPartnerCutoff(0);
    Bodies bodies;
    bodies.held[0] = {0, 0, 5e5, 0, 0, radius, 1e-10, 0, 0, 4e5};
    bodies.held[1] = {0, 0, 5e5, 3 * radius, 0, radius, 0, 0, 0, 4e5};
    bodies.step(transfer, {}, {{0, 0, growthFor(60), {0, 0, -1}}}, true);
    EXPECT_NEAR(bodies.charge[0] / saturationCharge(-1e6 + 1e5, radius, epsilon0), 1, 1e-12);
    bodies.charge = {0, 0};
    const double growth = 1e-14;
    bodies.step(transfer, {{0, 1, growth, {0, 0, 1}}}, {}, true);
    EXPECT_NEAR(bodies.charge[0] / (-epsilon0 * growth * 5e5), 1, 1e-6);
}

// ---------------------------------------------------------------------- losses and initial charges

TEST(ChargeLosses, leakageFallsExponentiallyWhateverTheTimeStepAndIsBooked)
{
    for (const int steps : {1, 10, 1000}) {
        ChargeLosses losses;
        losses.setRelaxationTime(0.2);
        double charge = -3e-10;
        for (int step = 0; step < steps; ++step) {
            charge = losses.after(charge, radius, 0.5 / steps, epsilon0);
        }
        EXPECT_NEAR(charge / -3e-10, std::exp(-2.5), 1e-13);
        EXPECT_NEAR((losses.leaked().value() + charge) / -3e-10, 1, 1e-14);
    }
}

TEST(ChargeLosses, breakdownHoldsTheSurfaceFieldAtItsLimitAndCounts)
{
    ChargeLosses losses;
    losses.setBreakdownField(3e6);
    const double largest = saturationCharge(3e6, radius, epsilon0);
    EXPECT_EQ(losses.after(0.99 * largest, radius, 1, epsilon0), 0.99 * largest);
    EXPECT_EQ(losses.breakdowns(), 0);
    EXPECT_EQ(losses.after(-1.5 * largest, radius, 1, epsilon0), -largest);
    EXPECT_EQ(losses.after(1.25 * largest, radius, 1, epsilon0), largest);
    EXPECT_EQ(losses.breakdowns(), 2);
    EXPECT_NEAR(losses.brokenDown().value() / largest, -0.25, 1e-14);
}

TEST(InitialCharges, areTheirValueTheirDistributionOrTheirShareOfSaturation)
{
    ChargingPairs pairs(3);
    pairs.setAtWall(2, 3, {-7e-6, -800}, 1);
    pairs.resolve(epsilon0);
    InitialCharges initial(3);
    EXPECT_FALSE(initial.any());
    initial.setValue(1, -4e-10);
    initial.setEquilibriumFraction(2, 0.5, 3);
    EXPECT_EQ(initial.of(1, 5, radius, pairs, epsilon0), -4e-10);
    for (const double size : {1e-3, 2e-3}) {
        EXPECT_NEAR(initial.of(2, 5, size, pairs, epsilon0) / (0.5 * saturationCharge(-7e-6 / epsilon0 - 800 / size, size, epsilon0)), 1, 1e-14);
    }
    EXPECT_EQ(initial.of(3, 5, radius, pairs, epsilon0), 0);
    InitialCharges spread(3);
    spread.setNormal(1, 1e-10, {2e-11, 3});
    EXPECT_EQ(spread.of(1, 5, radius, pairs, epsilon0), (1e-10 + ParticleSpread{2e-11, 3}.of(5)));
    EXPECT_EQ(refusal([&] { initial.setValue(1, 0); }), "initialCharge of type 1 is given twice");
    EXPECT_EQ(refusal([&] { initial.setValue(4, 0); }), "initialCharge: there is no type 4; the box has types 1 to 3");
    Complaints complaints;
    InitialCharges nowhere(3);
    nowhere.setEquilibriumFraction(1, 0.5, 3);
    nowhere.check(pairs, complaints);
    EXPECT_EQ(complaints.lines().at(0), "initialCharge 1: an equilibrium fraction needs a Gamma against type 3. Give that pair a law");
}

}  // namespace
