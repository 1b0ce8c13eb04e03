// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace him {
namespace {

double smallestDistance(const Points& position)
{
    double smallest = 1e300;
    for (Index row = 1; row < position.rows(); ++row) {
        const auto squares = (position.topRows(row).rowwise() - position.row(row)).square().rowwise().sum();
        smallest = std::min(smallest, squares.minCoeff());
    }
    return std::sqrt(smallest);
}

void expectHardSpheresInside(const Packing& packing, Index count)
{
    const double d = packing.diameter;
    ASSERT_EQ(packing.position.rows(), count);
    ASSERT_EQ(packing.charge.size(), count);
    EXPECT_GE(smallestDistance(packing.position), d * (1 - 1e-12));
    EXPECT_GE(packing.position.minCoeff(), 0.5 * d * (1 - 1e-12));
    EXPECT_LE(packing.position.maxCoeff(), packing.box.upper[0] - 0.5 * d * (1 - 1e-12));
}

TEST(Packings, areHardSpheresOfTheStatedNumber)
{
    expectHardSpheresInside(makePacking(Scene::dilute, 24, Signs::like), 264);
    expectHardSpheresInside(makePacking(Scene::dilute, 36, Signs::like, 1, 1e-4), 891);
    EXPECT_EQ(makePacking(Scene::dilute, 84, Signs::like).charge.size(), 11320);
    expectHardSpheresInside(makePacking(Scene::layer, 24, Signs::like, 1, 2e-3), 1476);
    const Packing bed = makePacking(Scene::bed, 12, Signs::like);
    expectHardSpheresInside(bed, 908);
    EXPECT_LE(bed.position.col(2).maxCoeff(), 5.5);
}

TEST(Packings, coverTheWallsWithTheLayer)
{
    const Packing layer = makePacking(Scene::layer, 24, Signs::like);
    int touching = 0;
    for (Index row = 0; row < layer.position.rows(); ++row) {
        const double gap = std::min(layer.position.row(row).minCoeff(), 24 - layer.position.row(row).maxCoeff());
        touching += std::abs(gap - 0.5) < 1e-12;
    }
    EXPECT_EQ(touching, 1476);
}

TEST(Packings, giveTheChargesAskedFor)
{
    const Packing like = makePacking(Scene::dilute, 36, Signs::like, 1, 1e-3, -2e-12);
    EXPECT_TRUE((like.charge == -2e-12).all());
    const Packing mixed = makePacking(Scene::dilute, 36, Signs::random, 1, 1e-3, 2e-12);
    EXPECT_TRUE((mixed.charge.abs() == 2e-12).all());
    EXPECT_LT(std::abs(mixed.charge.sum()), 3 * 2e-12 * std::sqrt(891.0));
}

TEST(Packings, repeatForOneSeedOnly)
{
    const Packing one = makePacking(Scene::bed, 12, Signs::random, 4);
    const Packing same = makePacking(Scene::bed, 12, Signs::random, 4);
    const Packing other = makePacking(Scene::bed, 12, Signs::random, 5);
    EXPECT_TRUE((one.position == same.position).all() && (one.charge == same.charge).all());
    EXPECT_FALSE((one.position == other.position).all());
}

}  // namespace
}  // namespace him
