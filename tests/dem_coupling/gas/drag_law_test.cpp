// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/drag_law.hpp"
#include "dem_coupling/gas/lift.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

namespace him {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double gravity = 9.81;

/// A polyethylene sphere of 277 um in nitrogen (Sippola et al. 2018).
DragPoint polyethylene(double voidFraction, double slip)
{
    return {voidFraction, slip, 277e-6, 1.149, 1.766e-5};
}

double stokesOf(const DragPoint& at)
{
    return 3 * pi * at.viscosity * at.diameter;
}

double volume(const DragPoint& at)
{
    return pi * std::pow(at.diameter, 3) / 6;
}

/// Room for spheres in nitrogen.
DragPoints spheres(Index rows)
{
    return {Scalars(rows), Scalars(rows), Scalars(rows), 1.149, 1.766e-5};
}

/// One sphere in the form of a law for many.
double drag(const std::string& name, const DragPoint& at)
{
    DragPoints points = spheres(1);
    points.voidFraction << at.voidFraction;
    points.slip << at.slip;
    points.diameter << at.diameter;
    Scalars beta;
    dragOfMany(name)(points, beta);
    return beta[0];
}

/// The same by the law of one sphere.
double oneSphereDrag(const std::string& name, const DragPoint& at)
{
    const std::map<std::string, double (*)(const DragPoint&)> laws{
        {"WenYu", wenYuDrag},       {"SchillerNaumann", schillerNaumannDrag},
        {"Gidaspow", gidaspowDrag}, {"Beetstra", beetstraDrag},
        {"DiFelice", diFeliceDrag}, {"KochHill", kochHillDrag}};
    return laws.at(name)(at);
}

/// Pressure gradient of a resting bed at a superficial velocity: alpha (-dp/dx) = beta (1 - alpha)/V_p slip.
template <class Law> double bedGradient(const Law& law, DragPoint at, double superficial)
{
    at.slip = superficial / at.voidFraction;
    return law(at) * (1 - at.voidFraction) / volume(at) * at.slip / at.voidFraction;
}

double ergunGradient(const DragPoint& at, double superficial)
{
    const double solid = 1 - at.voidFraction;
    return 150 * solid * solid * at.viscosity * superficial / (std::pow(at.voidFraction, 3) * at.diameter * at.diameter)
           + 1.75 * solid * at.density * superficial * superficial / (std::pow(at.voidFraction, 3) * at.diameter);
}

TEST(DragLaw, namesAllSixAndRefusesAnotherByListingThem)
{
    EXPECT_EQ(dragLawNames().size(), 6u);
    for (const std::string& name : dragLawNames()) {
        EXPECT_GT(drag(name, polyethylene(0.5, 0.3)), 0) << name;
    }
    try {
        dragOfMany("Stokes");
        FAIL() << "an unknown law was accepted";
    } catch (const std::invalid_argument& refusal) {
        EXPECT_STREQ(
            refusal.what(),
            "unknown drag law 'Stokes'; known: WenYu, SchillerNaumann, Gidaspow, Beetstra, DiFelice, KochHill");
    }
}

TEST(DragLaw, ofManySpheresIsThatOfEachToRoundOffAndToTheDigitWhateverStandsBesideIt)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(0, 1);
    for (const std::string& name : dragLawNames()) {
        for (const Index rows : {1, 7, 8, 43}) {
            DragPoints points = spheres(rows), turned = spheres(rows);
            for (Index row = 0; row < rows; ++row) {
                points.voidFraction[row] = row == 0 ? 1 : 0.35 + 0.65 * share(random);
                points.slip[row] = row == 1 ? 0 : std::pow(10, 6 * share(random) - 4);  // Re up to 1e3 and more
                points.diameter[row] = 1e-3 * share(random) + 1e-5;
            }
            turned.voidFraction = points.voidFraction.reverse();
            turned.slip = points.slip.reverse();
            turned.diameter = points.diameter.reverse();
            Scalars beta, turnedBeta;
            dragOfMany(name)(points, beta);
            dragOfMany(name)(turned, turnedBeta);
            ASSERT_EQ(beta.size(), rows);
            for (Index row = 0; row < rows; ++row) {
                const double one = oneSphereDrag(name, points.at(row));
                EXPECT_NEAR(beta[row] / one, 1, 1e-14) << name << " row " << row << " of " << rows;
                EXPECT_EQ(beta[row], turnedBeta[rows - 1 - row]) << name << " row " << row << " of " << rows;
            }
        }
    }
}

TEST(DragLaw, ofASingleCreepingSphereIsStokes)
{
    const DragPoint at = polyethylene(1, 1e-9);
    for (const char* name : {"WenYu", "SchillerNaumann", "Gidaspow", "Beetstra", "KochHill"}) {
        EXPECT_NEAR(drag(name, at) / stokesOf(at), 1, 2e-4) << name;
    }
    // Dallavalle's sphere has C_D Re = 4.8^2 = 23.04 where Stokes has 24.
    EXPECT_NEAR(drag("DiFelice", at) / stokesOf(at), 23.04 / 24, 1e-3);
}

TEST(DragLaw, isFiniteAndContinuousAtZeroSlip)
{
    for (const std::string& name : dragLawNames()) {
        for (const double voidFraction : {0.35, 0.55, 0.7, 0.9, 1.0}) {
            const double still = drag(name, polyethylene(voidFraction, 0));
            EXPECT_TRUE(std::isfinite(still) && still > 0) << name << ' ' << voidFraction;
            EXPECT_NEAR(drag(name, polyethylene(voidFraction, 1e-12)) / still, 1, 1e-4) << name << ' ' << voidFraction;
        }
    }
}

TEST(DragLaw, givesTheTerminalVelocityOfASinglePolyethyleneSphere)
{
    // 1.06136 m/s at Re 19.13 by Schiller and Naumann, with buoyancy and g = 9.81 m/s2 (bisection of the force balance).
    DragPoint at = polyethylene(1, 1);
    const double weight = (960 - at.density) * volume(at) * gravity;
    for (int n = 0; n < 200; ++n) {
        at.slip = 0.5 * (at.slip + weight / schillerNaumannDrag(at));
    }
    EXPECT_NEAR(at.slip, 1.06136, 1e-5);
    EXPECT_NEAR(superficialReynolds(at), 19.13, 0.005);
    EXPECT_NEAR(wenYuDrag(at), schillerNaumannDrag(at), 1e-18);
}

TEST(DragLaw, hasAConstantCoefficientAboveReynolds1000)
{
    EXPECT_NEAR(singleSphereDragTimesReynolds(2000) / 2000, 0.44, 1e-15);  // S2.8, not 0.44 Re
    EXPECT_NEAR(singleSphereDragTimesReynolds(1000 - 1e-6) / 1000, 24 * (1 + 0.15 * std::pow(1000, 0.687)) / 1000,
                1e-9);
    const DragPoint fast = polyethylene(1, 200);
    ASSERT_GT(superficialReynolds(fast), 1000);
    EXPECT_NEAR(schillerNaumannDrag(fast), pi / 8 * 0.44 * fast.density * fast.slip * std::pow(fast.diameter, 2),
                1e-20);
}

TEST(DragLaw, ofWenAndYuIsSippolasWithModelA)
{
    // S2.6 to S2.8 per volume: 3/4 C_D alpha (1 - alpha) rho |u - v|/d alpha^-2.65, times V_p/(1 - alpha) for one sphere.
    const DragPoint at = polyethylene(0.7, 0.9);
    const double reynolds = superficialReynolds(at);
    const double coefficient = 24 / reynolds * (1 + 0.15 * std::pow(reynolds, 0.687));
    const double perVolume = 0.75 * coefficient * 0.7 * 0.3 * at.density * at.slip / at.diameter * std::pow(0.7, -2.65);
    EXPECT_NEAR(wenYuDrag(at), perVolume * volume(at) / 0.3, 1e-14 * perVolume);
}

TEST(DragLaw, ofGidaspowIsErgunInPackedBeds)
{
    const DragPoint at = polyethylene(0.42, 0);
    for (const double superficial : {0.01, 0.1, 1.0}) {
        EXPECT_NEAR(bedGradient(gidaspowDrag, at, superficial) / ergunGradient(at, superficial), 1, 1e-12);
    }
}

TEST(DragLaw, ofGidaspowSwitchesAtVoidFraction80Percent)
{
    const DragPoint dense = polyethylene(0.8 - 1e-12, 0.5);
    const DragPoint dilute = polyethylene(0.8, 0.5);
    EXPECT_EQ(gidaspowDrag(dense), ergunDrag(dense));
    EXPECT_EQ(gidaspowDrag(dilute), wenYuDrag(dilute));
    EXPECT_GT(std::fabs(gidaspowDrag(dense) / gidaspowDrag(dilute) - 1), 0.01);  // the law jumps there
}

TEST(DragLaw, ofCreepingFlowInPackedBedsIsCarmans)
{
    // -dp/dx = 180 mu (1 - alpha)^2 U/(alpha^3 d^2): both laws were fitted to lattice-Boltzmann runs that obey it.
    const DragPoint at = polyethylene(0.4, 0);
    const double creeping = 1e-9;
    const double carman = 180 * at.viscosity * 0.36 * creeping / (0.064 * at.diameter * at.diameter);
    EXPECT_NEAR(bedGradient(kochHillDrag, at, creeping) / carman, 1, 1e-4);
    EXPECT_NEAR(bedGradient(beetstraDrag, at, creeping) / carman,
                1 + 0.4 * 0.4 * 0.4 * 0.4 * (1 + 1.5 * std::sqrt(0.6)) / 6,
                1e-3);  // and the second term of the law beside it
}

TEST(DragLaw, lawsOfPackedBedsAgreeWithinTheirScatter)
{
    // Ergun, Beetstra, Koch and Hill, Di Felice and Wen and Yu at alpha = 0.45 and the slip of minimum fluidisation.
    const DragPoint at = polyethylene(0.45, 0);
    const double reference = ergunGradient(at, 0.05);
    for (const char* name : {"Gidaspow", "Beetstra", "KochHill", "DiFelice", "WenYu"}) {
        const double ratio =
            bedGradient([&](const DragPoint& point) { return drag(name, point); }, at, 0.05) / reference;
        EXPECT_GT(ratio, 0.6) << name;
        EXPECT_LT(ratio, 1.6) << name;
    }
}

TEST(DragLaw, ofFastFlowHasTheValuesOfThePublishedFormulae)
{
    // beta/(3 pi mu d) at a Reynolds number of the superficial slip, worked out by hand: Beetstra as alpha F (24 alpha F is OpenFOAM's
    // C_D Re), Koch and Hill as alpha^2 (F0 + F3 Re/2) (18 mu/d^2 times that is CFDEM's), Di Felice as C_D Re/24 alpha^(1 - chi).
    struct Value {
        const char* name;
        double voidFraction, reynolds, beta;
    };
    for (const Value& value : {Value{"Beetstra", 0.45, 5, 12.7536212}, Value{"Beetstra", 0.5, 100, 25.2067139},
                               Value{"Beetstra", 0.7, 20, 6.83441995}, Value{"Beetstra", 0.9, 60, 5.73345769},
                               Value{"KochHill", 0.45, 5, 12.9518099}, Value{"KochHill", 0.5, 100, 21.44625},
                               Value{"KochHill", 0.7, 20, 5.94206221}, Value{"KochHill", 0.9, 60, 5.39209818},
                               Value{"DiFelice", 0.45, 5, 9.51857226}, Value{"DiFelice", 0.5, 100, 22.4149606},
                               Value{"DiFelice", 0.7, 20, 5.045799}, Value{"DiFelice", 0.9, 60, 4.8581088}}) {
        DragPoint at = polyethylene(value.voidFraction, 1);
        at.slip = value.reynolds / superficialReynolds(at);
        EXPECT_NEAR(drag(value.name, at) / stokesOf(at) / value.beta, 1, 1e-8)
            << value.name << ' ' << value.voidFraction << ' ' << value.reynolds;
    }
}

TEST(DragLaw, modelBGivesTheSamePressureDropAndForceInSteadyFlow)
{
    // A: alpha (-p') = n beta w, force beta w + V_p (-p'). B: -p' = n beta_B w, force beta_B w.
    const DragPoint at = polyethylene(0.42, 0.3);
    const double number = (1 - at.voidFraction) / volume(at);
    for (const std::string& name : dragLawNames()) {
        const double a = drag(name, at);
        const double b = dragOfModelB(a, at.voidFraction);
        const double gradientA = number * a * at.slip / at.voidFraction;
        EXPECT_NEAR(number * b * at.slip / gradientA, 1, 1e-13) << name;
        EXPECT_NEAR(b * at.slip / (a * at.slip + volume(at) * gradientA), 1, 1e-13) << name;
    }
}

TEST(DragLaw, namesThoseThatHoldWhereAnotherDoesNot)
{
    using Names = std::vector<std::string>;
    const auto holding = [](double voidFraction, double reynolds) {
        return dragLawNames(dragLawsThatHold(DragPoint{voidFraction, reynolds / voidFraction, 1, 1, 1}));
    };
    EXPECT_EQ(holding(0.38, 100), (Names{"Gidaspow", "KochHill"}));
    EXPECT_EQ(holding(0.95, 5000), (Names{"WenYu", "Gidaspow", "DiFelice"}));
    EXPECT_EQ(holding(0.99, 0), (Names{"WenYu", "SchillerNaumann", "Gidaspow", "DiFelice", "KochHill"}));
    EXPECT_TRUE(holding(0.3, 10).empty());
}

TEST(DragLaw, ofManySpheresSetsOffNoFloatingPointTrapAtRestOrInPureGas)
{
    constexpr int watched = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;
    for (const std::string& name : dragLawNames()) {
        for (const Index rows : {8, 9, 16}) {
            for (Index special = 0; special < rows; ++special) {
                for (const double voidFraction : {1.0, 1 + 1e-15, 0.6}) {
                    DragPoints points = spheres(rows);
                    points.voidFraction.setConstant(0.45);
                    points.slip.setConstant(0.3);
                    points.diameter.setConstant(277e-6);
                    points.voidFraction[special] = voidFraction;
                    points.slip[special] = voidFraction > 0.8 ? 0.3 : 0;
                    Scalars beta;
                    std::feclearexcept(FE_ALL_EXCEPT);
                    dragOfMany(name)(points, beta);
                    EXPECT_EQ(std::fetestexcept(watched), 0) << name << " row " << special << " of " << rows;
                    points.slip[special] = 0;
                    dragOfMany(name)(points, beta);
                    EXPECT_EQ(std::fetestexcept(watched), 0) << name << " at rest, row " << special << " of " << rows;
                    EXPECT_TRUE(beta.isFinite().all());
                }
            }
        }
    }
}

TEST(DragLaw, saysWhereItHasBeenShownToHold)
{
    // Re of the superficial slip; of the slip itself for Schiller and Naumann's single sphere.
    const auto holds = [](const char* name, double voidFraction, double reynolds) {
        DragPoint at = polyethylene(voidFraction, 1);
        at.slip = reynolds / (at.density * at.diameter / at.viscosity)
                  / (std::string(name) == "SchillerNaumann" ? 1 : voidFraction);
        return dragLawRange(name)(at);
    };
    struct Range {
        const char* name;
        double lowest, highest;     // void fraction
        double voidFraction, fast;  // largest Re there
    };
    for (const Range& range : {Range{"WenYu", 0.4, 1, 0.7, 2e5}, Range{"SchillerNaumann", 0.98, 1, 1, 2e5},
                               Range{"Gidaspow", 0.36, 1, 0.4, 1500}, Range{"Gidaspow", 0.36, 1, 0.9, 2e5},
                               Range{"Beetstra", 0.4, 0.9, 0.5, 1000}, Range{"DiFelice", 0.4, 1, 0.5, 1e4},
                               Range{"KochHill", 0.36, 1, 0.5, 120}}) {
        EXPECT_TRUE(holds(range.name, range.lowest + 1e-9, 1)) << range.name;
        EXPECT_FALSE(holds(range.name, range.lowest - 1e-9, 1)) << range.name;
        EXPECT_TRUE(holds(range.name, range.highest, 1)) << range.name;
        EXPECT_EQ(holds(range.name, 1, 1), range.highest == 1) << range.name;
        EXPECT_TRUE(holds(range.name, range.voidFraction, range.fast * (1 - 1e-9))) << range.name;
        EXPECT_FALSE(holds(range.name, range.voidFraction, range.fast * (1 + 1e-9))) << range.name;
    }
    for (const std::string& name : dragLawNames()) {
        EXPECT_NE(dragLawRangeInWords(name).find("void fraction"), std::string::npos);
        EXPECT_TRUE(dragLawRange(name)(polyethylene(name == "Beetstra" ? 0.9 : 1, 0))) << name << " creeps";
    }
    EXPECT_THROW(dragLawRange("Stokes"), std::invalid_argument);
}

TEST(SaffmanLift, holdsAtSmallReynoldsNumbersWhereShearIsMoreThanSlip)
{
    const auto holds = [](double ofSlip, double ofShear) {
        // density 1, viscosity 1, diameter 1
        return saffmanHolds(1, 1, 1, Vector3(0, 0, ofSlip), Vector3(0, ofShear, 0));
    };
    EXPECT_TRUE(holds(0, 0));
    EXPECT_TRUE(holds(0.3, 0.1));
    EXPECT_FALSE(holds(0.33, 0.1));
    EXPECT_TRUE(holds(1, 1));
    EXPECT_FALSE(holds(1.01, 1.1));
    EXPECT_FALSE(holds(0.5, 1.01));
}

TEST(SaffmanLift, drawsASphereThatLagsToWhereTheGasIsFaster)
{
    // u = rate z along x, curl u = rate along y; the sphere is slower by 0.2 m/s.
    const double rate = 80;
    const Vector3 lift = saffmanLift(1.2, 1.8e-5, 1e-4, Vector3(0.2, 0, 0), Vector3(0, rate, 0));
    // 6.46 r^2 sqrt(rho mu rate) w, Saffman 1968
    EXPECT_NEAR(lift[2], 6.46 * 0.25e-8 * std::sqrt(1.2 * 1.8e-5 * rate) * 0.2, 1e-15 * lift[2] + 1e-25);
    EXPECT_EQ(lift[0], 0);
    EXPECT_EQ(lift[1], 0);
    EXPECT_LT(saffmanLift(1.2, 1.8e-5, 1e-4, Vector3(-0.2, 0, 0), Vector3(0, rate, 0))[2], 0);
    EXPECT_EQ(saffmanLift(1.2, 1.8e-5, 1e-4, Vector3(0.2, 0, 0), Vector3::Zero()).norm(), 0);
}

}  // namespace
}  // namespace him
