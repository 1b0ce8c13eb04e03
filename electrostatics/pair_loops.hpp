// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The pair loops behind PairKernels. Included by one file per instruction set, see lanes.hpp.

#include "electrostatics/lanes.hpp"
#include "electrostatics/pair_kernels.hpp"

namespace him {
namespace {

enum class PairLaw { coulomb, withoutDoubleCount, screened1, screened2 };

template <class AnyLanes> struct VectorOf {
    AnyLanes x, y, z;
};
using LaneVector = VectorOf<Lanes>;

/// From a group of sources to the target. Never contracted, so that every kernel takes the same decision at the cutoff.
template <class AnyLanes> HIM_INLINE AnyLanes squaredLength(const VectorOf<AnyLanes>& d)
{
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// What a source of unit charge does: the field is `weight` times the separation.
template <class AnyLanes> struct UnitPairOf {
    AnyLanes weight, potential;
};
using UnitPair = UnitPairOf<Lanes>;

/// The short-range part of a charge cloud.
/// @param safe  r^2 where a pair counts, elsewhere any number that makes no infinity
/// @param u2    safe/R^2
template <PairLaw law, class AnyMask, class AnyLanes>
HIM_INLINE UnitPairOf<AnyLanes> screenedPair(AnyMask counts, AnyLanes safe, AnyLanes u2, const PairLimits& limits)
{
    const AnyLanes inverse = inverseSquareRoot(safe);
    const double* f = limits.cloudField;
    const double* p = limits.cloudPotential;
    AnyLanes field = broadcastLike(u2, f[1]);
    AnyLanes potential = broadcastLike(u2, p[2]);
    if constexpr (law == PairLaw::screened2) {
        field = mulAdd(u2, broadcastLike(u2, f[2]), field);
        potential = mulAdd(u2, broadcastLike(u2, p[3]), potential);
    }
    field = mulAdd(u2, field, f[0]);
    potential = mulAdd(u2, mulAdd(u2, potential, p[1]), p[0]);
    return {zeroUnless(counts, mulAdd(inverse * inverse, inverse, -field)), zeroUnless(counts, inverse - potential)};
}

template <PairLaw law> HIM_INLINE UnitPair unitPair(LaneMask counts, Lanes r2, const PairLimits& limits)
{
    if constexpr (law == PairLaw::coulomb) {
        // Lanes that do not count get any harmless distance: no infinity or overflow may arise in them.
        const Lanes inverse = inverseSquareRoot(select(counts, r2, allLanes(1.0)));
        const Lanes potential = zeroUnless(counts, inverse);
        return {inverse * inverse * potential, potential};
    } else if constexpr (law == PairLaw::withoutDoubleCount) {
        const Lanes inverse = inverseSquareRoot(select(counts, r2, allLanes(1.0)));
        return {zeroUnless(counts, inverse * inverse * inverse), Lanes{}};
    } else {
        const Lanes safe = select(counts, r2, allLanes(limits.cutoffSquared));
        return screenedPair<law>(counts, safe, safe * allLanes(limits.inverseSquaredRadius), limits);
    }
}

template <PairLaw law, bool mutual, int targetCount>
HIM_INLINE PairCount sumOverRanges(const PointArrays& t, const SumArrays& targetSums, const PointArrays& s,
                                   const RowRange* ranges, int rangeCount, const PairLimits& givenLimits,
                                   const SumArrays& sourceSums)
{
    const PairLimits limits = givenLimits;  // a copy that no store below can change
    constexpr bool hasPotential = law != PairLaw::withoutDoubleCount;
    LaneVector field[targetCount] = {};
    Lanes potential[targetCount] = {};
    PairCount count;
    LaneMask coincident{};
    for (int i = 0; i < rangeCount; ++i) {
        const std::ptrdiff_t end = ranges[i].end;
        for (std::ptrdiff_t k = ranges[i].begin; k < end; k += laneCount) {
            const LaneMask inRange = firstLanes(end - k);
            const LaneVector position{loadLanes(s.x + k), loadLanes(s.y + k), loadLanes(s.z + k)};
            const Lanes charge = loadLanes(s.q + k);
            LaneVector reaction{};
            Lanes reactionPotential{};
            if constexpr (mutual) {
                reaction = {loadLanes(sourceSums.x + k), loadLanes(sourceSums.y + k), loadLanes(sourceSums.z + k)};
                if constexpr (hasPotential) {
                    reactionPotential = loadLanes(sourceSums.potential + k);
                }
            }
#pragma GCC unroll 4
            for (int n = 0; n < targetCount; ++n) {
                const LaneVector d{allLanes(t.x[n]) - position.x, allLanes(t.y[n]) - position.y,
                                   allLanes(t.z[n]) - position.z};
                const Lanes r2 = squaredLength(d);
                const LaneMask within = inRange & atMost(r2, allLanes(limits.cutoffSquared));
                const LaneMask same = within & atMost(r2, allLanes(smallestDistance * smallestDistance));
                const LaneMask counts = within & ~same;
                count.pairs += countOf(counts);
                coincident |= same;

                const UnitPair unit = unitPair<law>(counts, r2, limits);
                if constexpr (law == PairLaw::withoutDoubleCount) {
                    const LaneVector c{allLanes(t.cellX[n]) - loadLanes(s.cellX + k),
                                       allLanes(t.cellY[n]) - loadLanes(s.cellY + k),
                                       allLanes(t.cellZ[n]) - loadLanes(s.cellZ + k)};
                    const Lanes c2 = squaredLength(c);
                    const LaneMask apart = counts & ~atMost(c2, allLanes(limits.sameCellSquared));
                    const Lanes cell = unitPair<PairLaw::withoutDoubleCount>(apart, c2, limits).weight;
                    const LaneVector e{unit.weight * d.x - cell * c.x, unit.weight * d.y - cell * c.y,
                                       unit.weight * d.z - cell * c.z};
                    field[n].x = mulAdd(charge, e.x, field[n].x);
                    field[n].y = mulAdd(charge, e.y, field[n].y);
                    field[n].z = mulAdd(charge, e.z, field[n].z);
                    if constexpr (mutual) {
                        const Lanes own = allLanes(-t.q[n]);
                        reaction.x = mulAdd(own, e.x, reaction.x);
                        reaction.y = mulAdd(own, e.y, reaction.y);
                        reaction.z = mulAdd(own, e.z, reaction.z);
                    }
                } else {
                    const Lanes weight = charge * unit.weight;
                    field[n].x = mulAdd(weight, d.x, field[n].x);
                    field[n].y = mulAdd(weight, d.y, field[n].y);
                    field[n].z = mulAdd(weight, d.z, field[n].z);
                    potential[n] = mulAdd(charge, unit.potential, potential[n]);
                    if constexpr (mutual) {
                        const Lanes own = allLanes(-t.q[n]) * unit.weight;
                        reaction.x = mulAdd(own, d.x, reaction.x);
                        reaction.y = mulAdd(own, d.y, reaction.y);
                        reaction.z = mulAdd(own, d.z, reaction.z);
                        reactionPotential = mulAdd(allLanes(t.q[n]), unit.potential, reactionPotential);
                    }
                }
            }
            if constexpr (mutual) {
                storeLanes(sourceSums.x + k, reaction.x);
                storeLanes(sourceSums.y + k, reaction.y);
                storeLanes(sourceSums.z + k, reaction.z);
                if constexpr (hasPotential) {
                    storeLanes(sourceSums.potential + k, reactionPotential);
                }
            }
        }
    }
    for (int n = 0; n < targetCount; ++n) {
        targetSums.x[n] += sumOf(field[n].x);
        targetSums.y[n] += sumOf(field[n].y);
        targetSums.z[n] += sumOf(field[n].z);
        if constexpr (hasPotential) {
            targetSums.potential[n] += sumOf(potential[n]);
        }
    }
    count.coincident = countOf(coincident) != 0;
    return count;
}

template <PairLaw law, bool mutual>
PairCount sumForTargets(const PointArrays& targets, int targetCount, const SumArrays& targetSums,
                        const PointArrays& sources, const RowRange* ranges, int rangeCount, const PairLimits& limits,
                        const SumArrays& sourceSums)
{
    static_assert(mostTargets == 4, "one instance for each number of targets");
    switch (targetCount) {
    case 1:
        return sumOverRanges<law, mutual, 1>(targets, targetSums, sources, ranges, rangeCount, limits, sourceSums);
    case 2:
        return sumOverRanges<law, mutual, 2>(targets, targetSums, sources, ranges, rangeCount, limits, sourceSums);
    case 3:
        return sumOverRanges<law, mutual, 3>(targets, targetSums, sources, ranges, rangeCount, limits, sourceSums);
    default:
        return sumOverRanges<law, mutual, 4>(targets, targetSums, sources, ranges, rangeCount, limits, sourceSums);
    }
}

template <PairLaw law>
PairCount sumSingle(const PointArrays& targets, int targetCount, const SumArrays& targetSums,
                    const PointArrays& sources, const RowRange* ranges, int rangeCount, const PairLimits& limits)
{
    return sumForTargets<law, false>(targets, targetCount, targetSums, sources, ranges, rangeCount, limits, {});
}

/// Between the rows [0, targetCount) of `t` and [begin, end) of `s`, and those after `end` that fill up a group of lanes: far
/// away by agreement, so that no lane needs a mask.
template <PairLaw law, bool mutual, int targetCount>
HIM_INLINE PairCount sumOverGathered(const GatheredPoints& t, const GatheredPoints& s, std::ptrdiff_t begin,
                                     std::ptrdiff_t end, const PairLimits& givenLimits)
{
    const PairLimits limits = givenLimits;
    VectorOf<SingleLanes> field[targetCount] = {};
    SingleLanes potential[targetCount] = {};
    SingleLanes closest = allSingleLanes(1.0F);
    const SingleLanes shortest = allSingleLanes(smallestSingleDistance * smallestSingleDistance);
    PairCount count;
    for (std::ptrdiff_t k = begin; k < end; k += singleLaneCount) {
        const VectorOf<SingleLanes> position{loadLanes(s.x + k), loadLanes(s.y + k), loadLanes(s.z + k)};
        const SingleLanes charge = loadLanes(s.q + k);
        VectorOf<SingleLanes> reaction{};
        SingleLanes reactionPotential{};
        if constexpr (mutual) {
            reaction = {loadLanes(s.fieldX + k), loadLanes(s.fieldY + k), loadLanes(s.fieldZ + k)};
            reactionPotential = loadLanes(s.potential + k);
        }
#pragma GCC unroll 4
        for (int n = 0; n < targetCount; ++n) {
            const VectorOf<SingleLanes> d{allSingleLanes(t.x[n]) - position.x, allSingleLanes(t.y[n]) - position.y,
                                          allSingleLanes(t.z[n]) - position.z};
            const SingleLanes r2 = mulAdd(d.x, d.x, mulAdd(d.y, d.y, d.z * d.z));
            const SingleMask counts = atMost(r2, allSingleLanes(1.0F));
            count.pairs += countOf(counts);
            closest = smaller(closest, r2);
            const SingleLanes u2 = smaller(larger(r2, shortest), allSingleLanes(1.0F));

            const UnitPairOf<SingleLanes> unit = screenedPair<law>(counts, u2, u2, limits);
            const SingleLanes weight = charge * unit.weight;
            field[n].x = mulAdd(weight, d.x, field[n].x);
            field[n].y = mulAdd(weight, d.y, field[n].y);
            field[n].z = mulAdd(weight, d.z, field[n].z);
            potential[n] = mulAdd(charge, unit.potential, potential[n]);
            if constexpr (mutual) {
                const SingleLanes own = allSingleLanes(-t.q[n]) * unit.weight;
                reaction.x = mulAdd(own, d.x, reaction.x);
                reaction.y = mulAdd(own, d.y, reaction.y);
                reaction.z = mulAdd(own, d.z, reaction.z);
                reactionPotential = mulAdd(allSingleLanes(t.q[n]), unit.potential, reactionPotential);
            }
        }
        if constexpr (mutual) {
            storeLanes(s.fieldX + k, reaction.x);
            storeLanes(s.fieldY + k, reaction.y);
            storeLanes(s.fieldZ + k, reaction.z);
            storeLanes(s.potential + k, reactionPotential);
        }
    }
    for (int n = 0; n < targetCount; ++n) {
        t.fieldX[n] += sumOf(field[n].x);
        t.fieldY[n] += sumOf(field[n].y);
        t.fieldZ[n] += sumOf(field[n].z);
        t.potential[n] += sumOf(potential[n]);
    }
    count.coincident = countOf(atMost(closest, shortest)) != 0;
    return count;
}

template <PairLaw law, bool mutual>
PairCount sumGathered(const GatheredPoints& targets, int targetCount, const GatheredPoints& points,
                      std::ptrdiff_t begin, std::ptrdiff_t end, const PairLimits& limits)
{
    switch (targetCount) {
    case 1:
        return sumOverGathered<law, mutual, 1>(targets, points, begin, end, limits);
    case 2:
        return sumOverGathered<law, mutual, 2>(targets, points, begin, end, limits);
    case 3:
        return sumOverGathered<law, mutual, 3>(targets, points, begin, end, limits);
    default:
        return sumOverGathered<law, mutual, 4>(targets, points, begin, end, limits);
    }
}

template <PairLaw law> constexpr PairKernels::SingleLaw singleKernelsOf()
{
    return {sumGathered<law, false>, sumGathered<law, true>};
}

template <PairLaw law> constexpr PairKernels::Law kernelsOf()
{
    return {sumSingle<law>, sumForTargets<law, true>};
}

constexpr PairKernels makeKernels(const char* instructionSet)
{
    return {instructionSet,
            kernelsOf<PairLaw::coulomb>(),
            kernelsOf<PairLaw::withoutDoubleCount>(),
            {kernelsOf<PairLaw::screened1>(), kernelsOf<PairLaw::screened2>()},
            {singleKernelsOf<PairLaw::screened1>(), singleKernelsOf<PairLaw::screened2>()}};
}

}  // namespace
}  // namespace him
