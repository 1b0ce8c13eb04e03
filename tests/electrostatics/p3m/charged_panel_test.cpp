// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/charged_panel.hpp"

#include "electrostatics/constants.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <random>

namespace him {

namespace {

struct Field {
    Vector3 field = Vector3::Zero();
    double potential = 0;
};

/// Sum of add(panel, its share of a unit charge, sum) over the pieces of a polygon.
template <class Add> Field sumOver(const std::vector<ChargedPanel>& panels, const Add& add)
{
    double area = 0;
    for (const ChargedPanel& panel : panels) {
        area += panel.area;
    }
    Field sum;
    for (const ChargedPanel& panel : panels) {
        add(panel, panel.area / area, sum);
    }
    return sum;
}

Field exactOf(const std::vector<ChargedPanel>& panels, const Vector3& place)
{
    return sumOver(panels, [&](const ChargedPanel& panel, double share, Field& sum) {
        FieldAtPlaces at;
        at.append(place[0], place[1], place[2]);
        at.finish();
        panel.addField(share, at);
        sum.field += Vector3(at.fieldX[0], at.fieldY[0], at.fieldZ[0]);
        sum.potential += at.potential[0];
    });
}

Field ofPoints(const std::vector<ChargedPanel>& panels, const Vector3& place)
{
    return sumOver(panels, [&](const ChargedPanel& panel, double share, Field& sum) {
        for (const ChargedPanel::Point& point : panel.points()) {
            const Vector3 r = place - point.position;
            sum.field += share * point.share * r / std::pow(r.norm(), 3);
            sum.potential += share * point.share / r.norm();
        }
    });
}

const std::vector<Vector3> square{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
const std::vector<Vector3> kite{{0, 0, 1}, {2, 0.3, 1}, {1.6, 1.9, 1}, {-0.4, 1.2, 1}};
const std::vector<Vector3> pentagon{{1, 0, 0}, {1, 1, 0.2}, {1, 1.4, 0.9}, {1, 0.6, 1.5}, {1, -0.3, 0.8}};

}  // namespace

TEST(ChargedPanel, hasTheFieldOfItsSolidAngleOnTheAxisOfASquare)
{
    for (const double z : {1e-3, 0.3, 2.0, 40.0}) {
        const Field found = exactOf(panelsOf(square, 9), {1, 1, z});
        // Solid angle of a square of side a at the height z
        const double a = 2;
        const double angle = 4 * std::asin(a * a / (a * a + 4 * z * z));
        EXPECT_NEAR(found.field[2] * a * a / angle, 1, 1e-11) << z;
        EXPECT_LT(found.field.head<2>().norm(), 1e-12);
    }
}

TEST(ChargedPanel, isASheetCloseToItsMiddleAndAPointFarAway)
{
    const Field close = exactOf(panelsOf(square, 9), {1.1, 0.9, -1e-9});
    EXPECT_NEAR(close.field[2], -2 * pi / 4, 1e-8);
    const Field far = exactOf(panelsOf(square, 9), {1 + 3e3, 1 + 2e3, 6e3});
    EXPECT_NEAR(far.potential * 7e3, 1, 1e-6);
    EXPECT_NEAR(far.field.norm() * 49e6, 1, 1e-6);
}

TEST(ChargedPanel, hasAPotentialWhoseGradientIsItsField)
{
    const double step = 1e-5;
    for (const auto& polygon : {square, kite, pentagon}) {
        for (const Vector3& place :
             {Vector3(0.4, 0.7, 1.3), Vector3(3, -1, 0.2), Vector3(1.2, 1.1, -0.4), Vector3(-1, 2, 1)}) {
            const auto panels = panelsOf(polygon, 0.9);
            const Field here = exactOf(panels, place);
            for (int axis = 0; axis < 3; ++axis) {
                const Vector3 along = step * Vector3::Unit(axis);
                const double slope =
                    (exactOf(panels, place + along).potential - exactOf(panels, place - along).potential) / (2 * step);
                EXPECT_NEAR(here.field[axis], -slope, 1e-8);
            }
        }
    }
}

TEST(ChargedPanel, doesTheSameToAPlaceWhateverOthersStandBesideIt)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> anywhere(-2, 4);
    for (const auto& polygon : {square, kite, {{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}}}) {
        const ChargedPanel panel = panelsOf(polygon, 9)[0];
        for (Index count = 1; count <= FieldAtPlaces::most; count += 7) {
            FieldAtPlaces together;
            for (Index n = 0; n < count; ++n) {
                together.append(anywhere(random), anywhere(random), anywhere(random));
            }
            together.finish();
            panel.addField(1.5, together);
            addFieldOfPoints(panel.points(), -1, together);
            for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) {
                FieldAtPlaces alone;
                alone.append(together.x[n], together.y[n], together.z[n]);
                alone.finish();
                panel.addField(1.5, alone);
                addFieldOfPoints(panel.points(), -1, alone);
                EXPECT_EQ(alone.fieldX[0], together.fieldX[n]);
                EXPECT_EQ(alone.fieldY[0], together.fieldY[n]);
                EXPECT_EQ(alone.fieldZ[0], together.fieldZ[n]);
                EXPECT_EQ(alone.potential[0], together.potential[n]);
            }
        }
    }
}

TEST(ChargedPanel, raisesNoTrapInItsPlaneAndOnItsDiagonalsAndHasTheSignOfTheSideNextToThem)
{
    // The host program stops at a division by zero, an invalid operation or an overflow.
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    const double side = 1e-3;
    const ChargedPanel panel =
        panelWith({Vector3(0, 0, 0), Vector3(side, 0, 0), Vector3(side, side, 0), Vector3(0, side, 0)}, 4);
    for (const double height : {0.0, 1e-300, 1e-20, 1e-9}) {
        for (const double x : {0.1, 0.5, 0.7, 1.5}) {
            for (const double y : {0.3, 0.5, 0.7}) {
                FieldAtPlaces both;
                both.append(x * side, y * side, height);
                both.append(x * side, y * side, -height);
                both.finish();
                panel.addField(side * side, both);
                EXPECT_EQ(both.fieldZ[0], -both.fieldZ[1]);
                // Nearer than round-off the side may be lost, on a diagonal.
                if (height == 0 || height > 1e-12) {
                    EXPECT_NEAR(both.fieldZ[0], height > 0 && x < 1 ? 2 * pi : 0, 1e-4) << x << ' ' << y;
                }
            }
        }
    }
    fedisableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
}

TEST(ChargedPanel, isTheSameHoweverItIsCut)
{
    const Vector3 place(0.7, 0.8, 1.4);
    for (const auto& polygon : {square, kite}) {
        const Field whole = exactOf(panelsOf(polygon, 9), place);
        const Field cut = exactOf(panelsOf(polygon, 0.3), place);
        EXPECT_LT((whole.field - cut.field).norm(), 1e-12);
        EXPECT_NEAR(whole.potential, cut.potential, 1e-12);
        EXPECT_GE(panelsOf(polygon, 0.3).size(), 30u);
    }
}

TEST(ChargedPanel, ofAPentagonIsFiveTrianglesWithTheFieldOfTheirPointsFarAway)
{
    const auto panels = panelsOf(pentagon, 9);
    EXPECT_EQ(panels.size(), 5u);
    const Vector3 place(7, 0.5, 0.6);
    const Field exact = exactOf(panels, place);
    EXPECT_LT((ofPoints(panels, place).field - exact.field).norm(), 1e-4 * exact.field.norm());
    EXPECT_GT(exact.field[0], 0);
}

TEST(ChargedPanel, isServedByItsPointsFromTwoRadiiOn)
{
    const std::vector<std::vector<Vector3>> flat{square, kite, {{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}}};
    for (const auto& polygon : flat) {
        const auto panels = panelsOf(polygon, 9);
        ASSERT_EQ(panels.size() == 1, polygon.size() == 4);
        double worst = 0;
        for (const Vector3& direction : {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(1, 0.3, 1)}) {
            const Vector3 place = panels[0].centre + 2 * panels[0].radius * direction.normalized();
            const Field exact = exactOf({panels[0]}, place);
            const Field points = ofPoints({panels[0]}, place);
            worst = std::max(worst, (points.field - exact.field).norm() / exact.field.norm());
        }
        std::printf("error of the points at two radii: %.2g\n", worst);
        EXPECT_LT(worst, 0.015);
    }
}

TEST(ChargedPanel, givesItsWholeChargeToItsPoints)
{
    for (const auto& polygon : {square, kite, pentagon}) {
        const auto panels = panelsOf(polygon, 0.7);
        for (const ChargedPanel& panel : panels) {
            double share = 0;
            for (const ChargedPanel::Point& point : panel.points()) {
                share += point.share;
            }
            EXPECT_NEAR(share, 1, 1e-12);
        }
        const Field far = ofPoints(panels, {0, 0, 1e4});
        EXPECT_NEAR(far.potential * 1e4, 1, 1e-3);
    }
}

}  // namespace him
