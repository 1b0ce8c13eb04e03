// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/transfer_limit.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"
#include "electrostatics/parameters/charging_efficiency.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

TEST(TransferLimit, fromSaturationChargeIsThatOfRTable1AndGivesTheChargeBack)
{
    // R Table 1: PTFE of 3.18 mm saturates at -6.57e-10 C.
    const double radius = 1.59e-3;
    const SaturationLaw law = saturationOfSphere(-6.57e-10, radius);
    const double limit = transferLimitAtWall(law, radius, epsilon0);
    EXPECT_NEAR(limit / (-6.57e-10 / (4 * pi * epsilon0 * radius * radius)), 1, 1e-15);
    EXPECT_NEAR(saturationCharge(limit, radius, epsilon0) / -6.57e-10, 1, 1e-15);
}

TEST(TransferLimit, ofOneMaterialWithoutSizeLawIsTheSameAtEverySize)
{
    const SaturationLaw law = saturationOfSphere(-3.441e-9, 6.35e-3);
    EXPECT_EQ(transferLimitAtWall(law, 1e-4, epsilon0), transferLimitAtWall(law, 6.35e-3, epsilon0));
}

TEST(TransferLimit, sizeLawThroughTwoSizesOfTable5SaturatesTheSpheresAtTheirCharges)
{
    // R Table 5, diameters: Gamma -1.52e6 V/m at 3.18 mm, -8.03e5 at 11.11 mm; the law through both (R19).
    const double radii[2] = {1.59e-3, 5.555e-3};
    const double limits[2] = {-1.52e6, -8.03e5};
    const double potential = (limits[0] - limits[1]) / (1 / radii[0] - 1 / radii[1]);
    const SaturationLaw law{epsilon0 * (limits[0] - potential / radii[0]), potential};
    const auto saturation = [&](double radius) {
        return saturationCharge(transferLimitAtWall(law, radius, epsilon0), radius, epsilon0);
    };
    EXPECT_NEAR(saturation(radii[0]), -0.4276e-9, 0.00005e-9);
    EXPECT_NEAR(saturation(radii[1]), -2.757e-9, 0.0005e-9);
    // Sizes that the law was not made from: 7.14 mm in between (Table 5) and 12.7 mm beyond (Table 6).
    EXPECT_NEAR(saturation(3.57e-3) / -1.364e-9, 1, 0.04);
    EXPECT_NEAR(saturation(6.35e-3) / -3.441e-9, 1, 0.02);
}

TEST(TransferLimit, ofTwoSpheresIsThatOfTheirSaturationChargesAndChangesSignWithTheirOrder)
{
    const SaturationLaw ptfe = saturationOfSphere(-6.57e-10, 1.59e-3);
    const SaturationLaw hdpe = saturationOfSphere(-3.91e-10, 1.59e-3);
    const double limit = transferLimitOfSpheres(ptfe, 1.59e-3, hdpe, 1.59e-3, epsilon0);
    EXPECT_NEAR(limit / transferLimitOfPair(1.59e-3, -6.57e-10, 1.59e-3, -3.91e-10), 1, 1e-14);
    EXPECT_EQ(transferLimitOfSpheres(hdpe, 1.59e-3, ptfe, 1.59e-3, epsilon0), -limit);
    EXPECT_LT(limit, 0);  // PTFE saturates at more negative charge, so it takes electrons from HDPE
}

TEST(TransferLimit, ofOneMaterialInTwoSizesChargesThemOppositelyOnlyUnderASizeLaw)
{
    const SaturationLaw sized{-7e-6, -800};
    EXPECT_NEAR(transferLimitOfSpheres(sized, 1e-3, sized, 2e-3, epsilon0), -800 / 1e-3 + 800 / 2e-3, 1e-6);
    const SaturationLaw plain{-7e-6, 0};
    EXPECT_EQ(transferLimitOfSpheres(plain, 1e-3, plain, 2e-3, epsilon0), 0);
}

TEST(TransferLimit, higherWorkFunctionChargesNegatively)
{
    // 0.1 eV over 500 nm: 2e5 V/m exactly.
    const double ev = elementaryCharge;
    EXPECT_NEAR(transferLimitOfWorkFunctions(4.1 * ev, 4.2 * ev, 500e-9), 2e5, 1e-6);
    EXPECT_EQ(transferLimitOfWorkFunctions(4.2 * ev, 4.1 * ev, 500e-9), -transferLimitOfWorkFunctions(4.1 * ev, 4.2 * ev, 500e-9));
    EXPECT_NEAR(transferLimitOfWorkFunctions(4.1 * ev, 4.2 * ev, 250e-9), 4e5, 1e-6);
}

TEST(TransferLimit, workFunctionsOfTheFluidizedBedGiveItsGammaAndEquilibriumCharge)
{
    // S bed at e/g = 1: Gamma 4.432e5 V/m, q_eq 9.459e-13 C for 277 um (S2.14).
    const double difference = 4.432e5 * 500e-9 * elementaryCharge;
    const double limit = transferLimitOfWorkFunctions(4 * elementaryCharge, 4 * elementaryCharge + difference, defaultChargeSeparation);
    EXPECT_NEAR(saturationCharge(limit, 138.5e-6, epsilon0) / 9.459e-13, 1, 5e-4);
}

TEST(TransferLimit, refusesWhatHasNoMeaning)
{
    EXPECT_EQ(refusal([] { saturationOfSphere(1e-9, 0); }), "radius must be > 0 and finite, found 0");
    EXPECT_EQ(refusal([] { transferLimitAtWall({}, -1, epsilon0); }), "radius must be > 0 and finite, found -1");
    EXPECT_EQ(refusal([] { transferLimitOfWorkFunctions(-1e-19, 7e-19, 500e-9); }),
              "work function must be > 0 and finite, found -1e-19");
    EXPECT_EQ(refusal([] { transferLimitOfWorkFunctions(6e-19, 7e-19, 0); }), "delta_e must be > 0 and finite, found 0");
}

}  // namespace
}  // namespace him
