// SPDX-License-Identifier: GPL-3.0-or-later
// R: Rasera et al. 2022, doi 10.1016/j.powtec.2022.117607. S: Sippola et al. 2018, J. Fluid Mech.
#include "electrostatics/constants.hpp"
#include "electrostatics/contact_area.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace him {
namespace {

// R Tables 1 and 2, PTFE on a rigid wall; the 3.18 mm column is a diameter.
constexpr double radius = 1.59e-3;   // [m]
constexpr double density = 2150.0;   // [kg/m3]
constexpr double modulus = 0.564e9;  // [Pa]
constexpr double poisson = 0.42;
constexpr double speed = 2.56;  // [m/s]
constexpr double mass = 4.0 / 3.0 * pi * radius * radius * radius * density;
constexpr double flatModulus = modulus / (1.0 - poisson * poisson);

TEST(ContactArea, ofAPtfeImpactOnARigidWallIsThatOfTheMeasuredSphere)
{
    EXPECT_NEAR(impactAreaOnRigidFlat(radius, density, modulus, poisson, speed), 1.832e-7, 0.0005e-7);
}

TEST(ContactArea, overlapAndTimeOfThePtfeImpact)
{
    const double overlap = hertzImpactOverlap(mass, flatModulus, radius, speed);
    EXPECT_NEAR(overlap, 36.7e-6, 0.05e-6);
    EXPECT_NEAR(hertzImpactTime(overlap, speed), 42.2e-6, 0.05e-6);
}

TEST(ContactArea, closedFormForTheRigidFlatIsTheHertzAreaAtTheLargestOverlap)
{
    const double overlap = hertzImpactOverlap(mass, flatModulus, radius, speed);
    EXPECT_NEAR(contactArea(AreaLaw::hertz, radius, overlap),
                impactAreaOnRigidFlat(radius, density, modulus, poisson, speed), 1e-19);
}

TEST(ContactArea, impactOverlapStoresTheKineticEnergy)
{
    const double overlap = hertzImpactOverlap(mass, flatModulus, radius, speed);
    const double elastic = 8.0 / 15.0 * flatModulus * std::sqrt(radius) * std::pow(overlap, 2.5);
    EXPECT_NEAR(elastic, 0.5 * mass * speed * speed, 1e-12 * elastic);
}

TEST(ContactArea, impactTimeFollowsFromIntegratingTheHertzMotion)
{
    const double exactFactor = 0.8 * std::sqrt(pi) * std::tgamma(0.4) / std::tgamma(0.9);
    EXPECT_NEAR(hertzImpactTime(2e-5, 4.0), exactFactor * 5e-6, 1e-18);
}

TEST(ContactArea, doubledLawIsTwiceTheHertzLaw)
{
    EXPECT_DOUBLE_EQ(contactArea(AreaLaw::hertz, 2e-3, 5e-6), pi * 1e-8);
    EXPECT_DOUBLE_EQ(contactArea(AreaLaw::doubled, 2e-3, 5e-6), 2.0 * pi * 1e-8);
    EXPECT_EQ(contactArea(AreaLaw::hertz, 2e-3, 0.0), 0.0);
}

TEST(ContactArea, effectiveRadiusIsSymmetricToTheLastBitAndHalvesEqualSpheres)
{
    EXPECT_EQ(effectiveRadius(1.7e-3, 0.3e-3), effectiveRadius(0.3e-3, 1.7e-3));
    EXPECT_DOUBLE_EQ(effectiveRadius(2e-3, 2e-3), 1e-3);
    EXPECT_NEAR(effectiveRadius(1e-3, 1e9), 1e-3, 1e-14);
}

TEST(ContactArea, rayleighStepIsTheTimeOfASurfaceWaveOverTheSphere)
{
    // R13: the wave runs the way pi r at (0.1631 nu + 0.8766) sqrt(G/rho); 69.45 us for the shaker's 12.7 mm PTFE.
    const double wave = (0.1631 * poisson + 0.8766) * std::sqrt(modulus / (2 * (1 + poisson)) / density);
    EXPECT_NEAR(rayleighTimeStep(radius, density, modulus, poisson) * wave / (pi * radius), 1, 1e-12);
    EXPECT_NEAR(rayleighTimeStep(6.35e-3, density, modulus, poisson), 6.945e-5, 1e-8);
}

TEST(ContactArea, softeningCorrectionsOfTheFluidizedBed)
{
    // S section 4.2: softened to 0.1 MPa; real 0.5 GPa, 0.46 (particle) and 74 GPa, 0.22 (wall).
    const auto effective = [](double young1, double poisson1, double young2, double poisson2) {
        return 1.0 / ((1.0 - poisson1 * poisson1) / young1 + (1.0 - poisson2 * poisson2) / young2);
    };
    const double pair = softeningCorrection(effective(1e5, 0.46, 1e5, 0.46), effective(0.5e9, 0.46, 0.5e9, 0.46));
    const double wall = softeningCorrection(effective(1e5, 0.46, 1e5, 0.22), effective(0.5e9, 0.46, 74e9, 0.22));
    EXPECT_NEAR(pair, 0.0331, 0.00005);
    EXPECT_NEAR(wall, 0.0242, 0.00005);
    EXPECT_DOUBLE_EQ(softeningCorrection(3e6, 3e6), 1.0);
}

TEST(ContactArea, softeningCorrectionUndoesTheLargerAreaOfASoftImpact)
{
    const double soft = contactArea(AreaLaw::hertz, radius, hertzImpactOverlap(mass, 1e5, radius, speed));
    const double real = contactArea(AreaLaw::hertz, radius, hertzImpactOverlap(mass, 1e9, radius, speed));
    EXPECT_NEAR(softeningCorrection(1e5, 1e9) * soft, real, 1e-12 * real);
}

TEST(ContactArea, lawsAreFoundByName)
{
    for (const AreaLaw law : {AreaLaw::hertz, AreaLaw::doubled}) {
        EXPECT_EQ(areaLawByName(nameOf(law)), law);
    }
    EXPECT_NE(nameOf(AreaLaw::hertz), nameOf(AreaLaw::doubled));
}

TEST(ContactArea, refusesWhatHasNoMeaning)
{
    EXPECT_EQ(refusal([] { areaLawByName("hertzian"); }),
              "unknown contact area law \"hertzian\"; known: hertz, doubled");
    EXPECT_EQ(refusal([] { contactArea(AreaLaw::hertz, 1e-3, -1e-9); }), "overlap must be >= 0, found -1e-09");
    EXPECT_EQ(refusal([] { contactArea(AreaLaw::hertz, 0.0, 1e-9); }),
              "effective radius must be > 0 and finite, found 0");
    EXPECT_EQ(refusal([] { effectiveRadius(1e-3, -2e-3); }), "radius must be > 0 and finite, found -0.002");
    EXPECT_EQ(refusal([] { effectiveRadius(std::numeric_limits<double>::infinity(), 1e-3); }),
              "radius must be > 0 and finite, found inf");
    EXPECT_EQ(refusal([] { softeningCorrection(std::nan(""), 1e9); }),
              "softened modulus must be > 0 and finite, found nan");
    EXPECT_EQ(refusal([] { impactAreaOnRigidFlat(1e-3, 1e3, 1e9, 0.6, 1.0); }),
              "Poisson's ratio must be above -1 and at most 0.5, found 0.6");
}

}  // namespace
}  // namespace him
