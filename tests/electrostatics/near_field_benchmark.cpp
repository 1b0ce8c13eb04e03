// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of the near sums in a dense packing: a shaken face-centred cubic lattice of spheres at 50 % by volume, cutoff in
// sphere diameters. Reported: nanoseconds per pair within the cutoff and pairs per particle.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

namespace him {
namespace {

constexpr double diameter = 277e-6;  // [m]

ChargedPoints densePacking(Index count)
{
    const double edge = diameter * std::cbrt(4.0 * pi / 6.0 / 0.5);  // four spheres in a cube of this edge
    const Index cubes = static_cast<Index>(std::ceil(std::cbrt(static_cast<double>(count) / 4.0)));
    const double meshCell = 2.5 * diameter;
    const double offset[4][3] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
    std::mt19937 random(1);
    std::uniform_real_distribution<double> shake(-0.04 * diameter, 0.04 * diameter);
    std::normal_distribution<double> charge(1e-12, 5e-13);

    ChargedPoints points;
    points.position.resize(count, 3);
    points.charge.resize(count);
    for (Index row = 0; row < count; ++row) {
        const Index cube = row / 4;
        const double corner[3] = {double(cube % cubes), double(cube / cubes % cubes), double(cube / cubes / cubes)};
        for (int axis = 0; axis < 3; ++axis) {
            points.position(row, axis) = edge * (corner[axis] + offset[row % 4][axis]) + shake(random);
        }
        points.charge[row] = charge(random);
    }
    points.cellCentre = ((points.position / meshCell).floor() + 0.5) * meshCell;
    points.targets = count;
    return points;
}

void report(benchmark::State& state, const PairSumResult& result, Index count)
{
    const double pairs = static_cast<double>(result.pairs);
    state.counters["pairsPerParticle"] = pairs / static_cast<double>(count);
    state.counters["perPair"] =
        benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["perParticle"] = benchmark::Counter(
        static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// @param sum  sum(nearField, points, result)
template <class Sum> void timeNearSum(benchmark::State& state, const Sum& sum)
{
    const ChargedPoints points = densePacking(state.range(0));
    NearField nearField(0.1 * static_cast<double>(state.range(1)) * diameter, epsilon0);
    PairSumResult result;
    for (auto step : state) {
        sum(nearField, points, result);
        benchmark::DoNotOptimize(result.field.data());
    }
    report(state, result, points.targets);
}

void coulomb(benchmark::State& state)
{
    timeNearSum(state, [](NearField& near, const ChargedPoints& points, PairSumResult& result) {
        near.coulomb(points, result);
    });
}

void coulombWithoutDoubleCount(benchmark::State& state)
{
    timeNearSum(state, [](NearField& near, const ChargedPoints& points, PairSumResult& result) {
        near.coulombWithoutDoubleCount(points, result);
    });
}

template <int exponent, NearPrecision precision> void screened(benchmark::State& state)
{
    timeNearSum(state, [](NearField& near, const ChargedPoints& points, PairSumResult& result) {
        near.screened(points, ChargeCloud(near.cutoff(), exponent), result, precision);
    });
}

void allPairs(benchmark::State& state)
{
    const ChargedPoints points = densePacking(state.range(0));
    PairSumResult result;
    for (auto step : state) {
        result.field.setZero(points.targets, 3);
        result.potential.setZero(points.targets);
        result.pairs =
            addAllPairs(points.position, points.position, points.charge, 0, epsilon0, result.field, result.potential);
    }
    report(state, result, points.targets);
}

void nearArguments(benchmark::internal::Benchmark* benchmark)
{
    benchmark->ArgNames({"points", "tenthDiameters"})->Unit(benchmark::kMillisecond);
    // About 50, 150, 250 and 500 neighbours inside the packing.
    for (const std::int64_t cutoff : {25, 36, 43, 54}) {
        benchmark->Args({20000, cutoff});
    }
}

BENCHMARK(coulomb)->Apply(nearArguments);
BENCHMARK(coulombWithoutDoubleCount)->Apply(nearArguments);
BENCHMARK(screened<1, NearPrecision::doublePrecision>)->Apply(nearArguments);
BENCHMARK(screened<2, NearPrecision::doublePrecision>)->Apply(nearArguments);
BENCHMARK(screened<1, NearPrecision::singlePrecision>)->Apply(nearArguments);
BENCHMARK(screened<2, NearPrecision::singlePrecision>)->Apply(nearArguments);
BENCHMARK(allPairs)->ArgName("points")->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace him

BENCHMARK_MAIN();
