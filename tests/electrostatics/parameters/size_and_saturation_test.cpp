// SPDX-License-Identifier: GPL-3.0-or-later
// R: Rasera et al. 2022, doi 10.1016/j.powtec.2022.117607.
#include "electrostatics/parameters/saturation_fit.hpp"
#include "electrostatics/parameters/size_law.hpp"
#include "tests/electrostatics/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

// R Table 5; diameters.
const std::vector<SizePoint> table5 = {{1.59e-3, {-1.52e6, -1.60e6, -1.44e6, -1.60e6, -1.44e6}},
                                       {3.57e-3, {-9.62e5, -1.01e6, -9.16e5, -1.01e6, -9.16e5}},
                                       {5.555e-3, {-8.03e5, -8.41e5, -7.66e5, -8.41e5, -7.66e5}}};
const std::vector<Estimate> efficiencies = {
    {27.2, 17.1, 44.4, 17.1, 44.4}, {13.0, 6.1, 34.0, 6.1, 34.0}, {19.7, 13.0, 28.1, 13.0, 28.1}};

TEST(SizeLaw, predictsTheLargestSpheresOfTable6FromTheSizesOfTable5)
{
    const Estimate limit = predictedTransferLimit(table5, 6.35e-3);
    EXPECT_NEAR(limit.value, -7.67e5, 0.002 * 7.67e5);
    EXPECT_NEAR(limit.minimum, -8.03e5, 0.002 * 8.03e5);
    EXPECT_NEAR(limit.maximum, -7.32e5, 0.002 * 7.32e5);

    const Estimate efficiency = predictedEfficiency(efficiencies);
    EXPECT_NEAR(efficiency.value, 20.0, 0.05);
    EXPECT_NEAR(efficiency.minimum, 12.0, 0.1);
    EXPECT_NEAR(efficiency.maximum, 35.5, 0.05);
}

TEST(SizeLaw, ofTwoSizesHasTheIntervalOfEitherAtItsRadiusAndMoreBeyondThem)
{
    const std::vector<SizePoint> two = {{1e-3, {-2e6, -2.1e6, -1.8e6, -2.3e6, -1.7e6}},
                                        {4e-3, {-1e6, -1.1e6, -0.9e6, -1.2e6, -0.8e6}}};
    for (const SizePoint& size : two) {
        const Estimate there = predictedTransferLimit(two, size.radius);
        EXPECT_NEAR(there.value, size.transferLimit.value, 1e-6);
        EXPECT_NEAR(there.lower95, size.transferLimit.lower95, 1e-6);
        EXPECT_NEAR(there.upper95, size.transferLimit.upper95, 1e-6);
        EXPECT_NEAR(there.minimum, size.transferLimit.minimum, 1e-6);
        EXPECT_NEAR(there.maximum, size.transferLimit.maximum, 1e-6);
    }
    const Estimate beyond = predictedTransferLimit(two, 8e-3);
    EXPECT_GT(beyond.upper95 - beyond.lower95, 1.1 * 0.2e6);
}

TEST(SizeLaw, goesThroughTwoSizesExactlyAndThroughMoreInTheMean)
{
    const SizeLaw law{-5e5, -1600};
    const SizeLaw found = fitSizeLaw({1e-3, 4e-3}, {law.transferLimit(1e-3), law.transferLimit(4e-3)});
    EXPECT_NEAR(found.planeField, law.planeField, 1e-6);
    EXPECT_NEAR(found.surfacePotential, law.surfacePotential, 1e-9);
    const SizeLaw three = fitSizeLaw({1e-3, 2e-3, 4e-3}, {-3e6, -2e6, -1.2e6});
    const double misses =
        three.transferLimit(1e-3) + 3e6 + three.transferLimit(2e-3) + 2e6 + three.transferLimit(4e-3) + 1.2e6;
    EXPECT_NEAR(misses, 0, 1e-6);
}

TEST(SizeLaw, refusesSizesThatFixNoLine)
{
    EXPECT_EQ(refusal([] {
                  fitSizeLaw({1e-3, 1e-3}, {-1e6, -2e6});
              }),
              "number of different radii of the size law must be 2 or more, found 1");
    EXPECT_EQ(refusal([] { fitSizeLaw({1e-3, -1e-3}, {-1e6, -2e6}); }), "radius must be > 0 and finite, found -0.001");
}

std::vector<double> every(double step, int count)
{
    std::vector<double> n;
    for (int k = 0; k < count; ++k) {
        n.push_back(step * k);
    }
    return n;
}

std::vector<double> curve(const std::vector<double>& n, double saturation, double start, double decay, double noise)
{
    std::vector<double> q;
    for (std::size_t k = 0; k < n.size(); ++k) {
        // Any numbers without a trend serve as noise.
        q.push_back(saturation + (start - saturation) * std::exp(-decay * n[k])
                    + noise * std::sin(12.9898 * (double(k) + 1)));
    }
    return q;
}

TEST(SaturationFit, findsTheNumbersOfACleanCurve)
{
    const std::vector<double> n = every(2, 40);
    const SaturationFit fit = fitSaturation(n, curve(n, -4.276e-10, 3e-11, 0.104, 0));
    EXPECT_NEAR(fit.saturationCharge.value, -4.276e-10, 1e-16);
    EXPECT_NEAR(fit.initialCharge.value, 3e-11, 1e-16);
    EXPECT_NEAR(fit.decay.value, 0.104, 1e-7);
    EXPECT_LT(fit.residual, 1e-17);
}

TEST(SaturationFit, intervalsHoldTheTruthAndGrowWithTheNoise)
{
    const std::vector<double> n = every(2, 60);
    double before = 0;
    for (const double noise : {1e-12, 4e-12}) {
        const SaturationFit fit = fitSaturation(n, curve(n, -4e-10, 0, 0.1, noise));
        EXPECT_LT(fit.saturationCharge.lower, -4e-10);
        EXPECT_GT(fit.saturationCharge.upper, -4e-10);
        EXPECT_LT(fit.decay.lower, 0.1);
        EXPECT_GT(fit.decay.upper, 0.1);
        const double width = fit.decay.upper - fit.decay.lower;
        EXPECT_GT(width, 3 * before);
        before = width;
    }
}

TEST(SaturationFit, refusesReadingsThatHoldNoSaturation)
{
    EXPECT_EQ(refusal([] {
                  fitSaturation({0, 2, 4}, {0, 1, 2});
              }),
              "number of charge readings must be 4 or more, found 3");
    EXPECT_EQ(refusal([] {
                  fitSaturation({0, 2, 4, 4}, {0, 1, 2, 3});
              }),
              "number of contacts must be greater than that of the reading before, found 4");
    EXPECT_EQ(refusal([] {
                  fitSaturation({0, 2, 4, 6}, {1, 1, 1, 1});
              }),
              "all charge readings are the same: they hold no charging efficiency");
    EXPECT_EQ(refusal([] {
                  fitSaturation({0, 2, 4, 6, 8}, {0, 1, 2, 3, 4});
              }),
              "the charge readings do not bend towards saturation; record more contacts");
}

}  // namespace
}  // namespace him
