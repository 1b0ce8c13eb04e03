// SPDX-License-Identifier: GPL-3.0-or-later
// R: Rasera et al. 2022, doi 10.1016/j.powtec.2022.117607.
#include "electrostatics/parameters/measurement.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace him {
namespace {

/// R Tables 1 and 2, PTFE on aluminium.
Measurement ptfe()
{
    Measurement m;
    m.particle = {Measured::exact(1.59e-3),   2150, {0.564e9, 0.42}, Measured::exact(-1.71e-10),
                  Measured::exact(-6.57e-10), {}};
    m.chargeTransfer = Measured::exact(-2.70e-11);
    m.normalSpeed = Measured::exact(2.56);
    return m;
}

/// Two different spheres that begin without charge.
Measurement dissimilar()
{
    Measurement m = ptfe();
    m.atWall = false;
    m.particle.initialCharge = Measured::exact(0);
    m.partner = {Measured::exact(2e-3), 1140, {1.27e9, 0.49}, Measured::exact(0), Measured::exact(3e-10), {}};
    m.chargeTransfer = Measured::exact(-1e-11);
    return m;
}

Measurement similar()
{
    Measurement m;
    m.atWall = false;
    m.similar = true;
    m.particle = {Measured::exact(1.59e-3), 1140, {1.27e9, 0.49}, Measured::exact(0), {}, {}};
    m.partner.initialCharge = Measured::exact(2.548e-11);
    m.chargeTransfer = Measured::exact(8.57e-13);
    m.normalSpeed = Measured::exact(1.71 * std::cos(0.33));
    return m;
}

TEST(Flowchart, asksForWhatIsKnownAndEndsInItsOwnBranchEveryTime)
{
    Measurement history = ptfe();
    history.chargeTransfer.reset();
    history.particle.saturationCharge.reset();
    history.historyContacts = {0, 2, 4, 6};
    history.historyCharges = {0, -1e-10, -1.5e-10, -1.75e-10};
    Measurement wallSaturation = ptfe();
    wallSaturation.chargeTransfer.reset();
    Measurement wallTransfer = ptfe();
    wallTransfer.particle.saturationCharge.reset();
    Measurement pairSaturation = dissimilar();
    pairSaturation.chargeTransfer.reset();
    Measurement pairTransfer = dissimilar();
    pairTransfer.partner.saturationCharge.reset();  // one of two is not enough
    Measurement equal = similar();
    equal.partner.initialCharge = Measured::exact(0);

    const std::pair<Measurement, Branch> cases[] = {{ptfe(), Branch::particleWall},
                                                    {wallSaturation, Branch::particleWallSaturationOnly},
                                                    {wallTransfer, Branch::particleWallWithoutSaturation},
                                                    {history, Branch::particleWallHistory},
                                                    {dissimilar(), Branch::dissimilarPair},
                                                    {pairSaturation, Branch::dissimilarPairSaturationOnly},
                                                    {pairTransfer, Branch::dissimilarPairWithoutSaturation},
                                                    {similar(), Branch::similarPair},
                                                    {equal, Branch::similarPairNearlyEqual}};
    std::set<std::string> reached;
    for (const auto& [measurement, branch] : cases) {
        EXPECT_EQ(nameOf(branchOf(measurement)), nameOf(branch));
        EXPECT_FALSE(equationsOf(branch).empty());
        reached.insert(nameOf(branch));
    }
    EXPECT_EQ(reached.size(), allBranches().size());
}

TEST(ChargingParametersOf, aWallImpactAreGammaAndKappaOfTable1)
{
    const ChargingParameters p = parametersOf(ptfe());
    EXPECT_TRUE(faultsOf(ptfe()).empty());
    EXPECT_NEAR(p.transferLimit->value, -2.34e6, 0.002 * 2.34e6);
    EXPECT_NEAR(p.efficiencyFrozen->value, 9.64, 0.002 * 9.64);
    EXPECT_NEAR(p.contactArea->value, 1.832e-7, 0.0005e-7);
    // updated: -ln(1 - s) in place of s = dq/(q_sat - q_i)
    const double share = 2.70e-11 / (6.57e-10 - 1.71e-10);
    EXPECT_NEAR(p.efficiencyUpdated->value / p.efficiencyFrozen->value, -std::log1p(-share) / share, 1e-12);
    EXPECT_NEAR(p.contactsTo95->value, std::log(0.05) / std::log(1 - share), 1e-9);
    EXPECT_FALSE(p.limitTimesEfficiency);
}

TEST(ChargingParametersOf, intervalsOfInputsBecomeIntervalsOfParameters)
{
    Measurement m = ptfe();
    m.particle.saturationCharge = Measured{-6.57e-10, -7.0e-10, -6.2e-10};
    m.chargeTransfer = Measured{-2.7e-11, -3.0e-11, -2.4e-11};
    const ChargingParameters p = parametersOf(m);
    EXPECT_NEAR(p.transferLimit->minimum / p.transferLimit->value, 7.0 / 6.57, 1e-12);
    EXPECT_NEAR(p.transferLimit->maximum / p.transferLimit->value, 6.2 / 6.57, 1e-12);
    // kappa is largest with the largest transfer and the smallest distance to saturation (R20)
    const double factor = p.efficiencyFrozen->value * (6.57e-10 - 1.71e-10) / 2.7e-11;
    EXPECT_NEAR(p.efficiencyFrozen->maximum, factor * 3.0e-11 / (6.2e-10 - 1.71e-10), 1e-9);
    EXPECT_NEAR(p.efficiencyFrozen->minimum, factor * 2.4e-11 / (7.0e-10 - 1.71e-10), 1e-9);
    EXPECT_GT(p.efficiencyFrozen->lower95, p.efficiencyFrozen->minimum);
    EXPECT_LT(p.efficiencyFrozen->upper95, p.efficiencyFrozen->maximum);
}

TEST(ChargingParametersOf, kappaOfAWallImpactDoesNotDependOnTheRadius)
{
    // R25 scales with r^2, and so does R20.
    Measurement m = ptfe();
    m.particle.radius = {1.59e-3, 1.5e-3, 1.7e-3};
    const ChargingParameters p = parametersOf(m);
    EXPECT_NEAR(p.efficiencyFrozen->minimum / p.efficiencyFrozen->maximum, 1, 1e-12);
    EXPECT_LT(p.transferLimit->minimum, 1.1 * p.transferLimit->value);
}

TEST(ChargingParametersOf, anAreaFromADemRunReplacesTheImpact)
{
    Measurement m = ptfe();
    m.normalSpeed.reset();
    m.area = Measured::exact(2 * 1.8318e-7);
    EXPECT_NEAR(parametersOf(m).efficiencyFrozen->value, 9.64 / 2, 0.002 * 9.64);
}

TEST(ChargingParametersOf, gammaInPlaceOfTheSaturationChargeGivesTheSame)
{
    Measurement m = ptfe();
    m.particle.transferLimit = Measured::exact(parametersOf(m).transferLimit->value);
    m.particle.saturationCharge.reset();
    EXPECT_NEAR(parametersOf(m).efficiencyFrozen->value, parametersOf(ptfe()).efficiencyFrozen->value, 1e-9);
    EXPECT_NEAR(parametersOf(m).saturationCharge->value, -6.57e-10, 1e-21);
}

TEST(ChargingParametersOf, aHistoryHoldsGammaAndKappa)
{
    Measurement m = ptfe();
    m.chargeTransfer.reset();
    m.particle.saturationCharge.reset();
    const double area = parametersOf(ptfe()).contactArea->value;
    const double x = 27.2 * area / (4 * 3.14159265358979 * 1.59e-3 * 1.59e-3);
    for (int k = 0; k < 30; ++k) {
        m.historyContacts.push_back(2 * k);
        m.historyCharges.push_back(-4.276e-10 * -std::expm1(-x * 2 * k));
    }
    const ChargingParameters p = parametersOf(m);
    EXPECT_NEAR(p.efficiencyUpdated->value, 27.2, 1e-4);
    EXPECT_NEAR(p.efficiencyFrozen->value, 27.2 * -std::expm1(-x) / x, 1e-4);
    EXPECT_NEAR(p.transferLimit->value, -1.52e6, 0.001 * 1.52e6);
    EXPECT_NEAR(p.contactsTo95->value, -std::log(0.05) / x, 1e-3);
}

void expectFault(const Measurement& m, const std::string& part)
{
    const std::vector<std::string> faults = faultsOf(m);
    ASSERT_EQ(faults.size(), 1u) << (faults.empty() ? "no fault" : faults[1]);
    EXPECT_NE(faults[0].find(part), std::string::npos) << faults[0];
}

TEST(ImpossibleMeasurements, areRefusedWithTheReason)
{
    Measurement wrongSign = ptfe();
    wrongSign.chargeTransfer = Measured::exact(2.7e-11);
    expectFault(wrongSign,
                "has the wrong sign: with these charges the particle can gain negative charge only, up to -4.86e-10 C");

    Measurement beyond = ptfe();
    beyond.particle.initialCharge = Measured::exact(-7e-10);
    beyond.chargeTransfer.reset();
    expectFault(beyond, "begins with -7e-10 C, beyond its saturation charge of -6.57e-10 C");

    Measurement tooMuch = ptfe();
    tooMuch.chargeTransfer = Measured::exact(-5e-10);
    expectFault(tooMuch, "is more than the -4.86e-10 C that bring the particle to saturation");

    Measurement noArea = ptfe();
    noArea.normalSpeed.reset();
    noArea.area = Measured::exact(0);
    expectFault(noArea, "the contact area and its whole interval must be above zero, found 0 m2");

    Measurement nothingMoved = ptfe();
    nothingMoved.chargeTransfer = Measured::exact(0);
    expectFault(nothingMoved, "a contact that moves nothing holds no kappa_c");

    Measurement reversed = ptfe();
    reversed.normalSpeed = Measured{2.56, 2.7, 2.8};
    expectFault(reversed, "the average of the normal speed, 2.56, must be within its interval, 2.7 to 2.8");

    Measurement unknown = ptfe();
    unknown.particle.saturationCharge.reset();
    unknown.chargeTransfer.reset();
    expectFault(unknown, "neither a saturation charge nor a charge transfer is known");

    Measurement charged = dissimilar();
    charged.partner.saturationCharge.reset();
    charged.partner.initialCharge = Measured::exact(1e-11);
    expectFault(charged, "R24 holds for particles that begin without charge");

    Measurement pair = similar();
    pair.chargeTransfer = Measured::exact(1.3e-11);
    expectFault(pair, "is more than the 1.274e-11 C that bring both particles to equilibrium");
}

TEST(ImpossibleMeasurements, areAllReportedAtOnce)
{
    Measurement m = ptfe();
    m.particle.radius = Measured::exact(-1e-3);
    m.normalSpeed = Measured::exact(0);
    m.particle.initialCharge = Measured::exact(-7e-10);
    EXPECT_EQ(faultsOf(m).size(), 2u);  // the charge cannot be judged without a radius in case Gamma is given
}

TEST(ImpossibleMeasurements, withinTheIntervalsAreRefusedToo)
{
    Measurement m = ptfe();
    m.particle.saturationCharge = Measured{-6.57e-10, -1.2e-9, -1.9e-10};  // reaches below q_i + dq
    EXPECT_TRUE(faultsOf(m).empty());
    EXPECT_NE(refusal([&] { parametersOf(m); }).find("above 0 and below 1"), std::string::npos);
}

}  // namespace
}  // namespace him
