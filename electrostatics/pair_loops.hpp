// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The pair loops behind PairKernels. Included by one file per instruction set, see lanes.hpp.

#include "electrostatics/lanes.hpp"
#include "electrostatics/pair_kernels.hpp"

namespace him {
namespace {

enum class PairLaw { coulomb, withoutDoubleCount, screened1, screened2 };

struct LaneVector {
    Lanes x, y, z;
};

/// From a group of sources to the target. Never contracted, so that every kernel takes the same decision at the cutoff.
HIM_INLINE Lanes squaredLength(const LaneVector& d)
{
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// What a source of unit charge does: the field is `weight` times the separation.
struct UnitPair {
    Lanes weight, potential;
};

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
        const Lanes inverse = inverseSquareRoot(safe);
        const Lanes u2 = safe * allLanes(limits.inverseSquaredRadius);
        const double* f = limits.cloudField;
        const double* p = limits.cloudPotential;
        Lanes field = allLanes(f[1]);
        Lanes potential = allLanes(p[2]);
        if constexpr (law == PairLaw::screened2) {
            field = mulAdd(u2, allLanes(f[2]), field);
            potential = mulAdd(u2, allLanes(p[3]), potential);
        }
        field = mulAdd(u2, field, f[0]);
        potential = mulAdd(u2, mulAdd(u2, potential, p[1]), p[0]);
        return {zeroUnless(counts, mulAdd(inverse * inverse, inverse, -field)),
                zeroUnless(counts, inverse - potential)};
    }
}

template <PairLaw law, bool mutual, int targetCount>
HIM_INLINE PairCount sumOverRanges(const PointArrays& t, const SumArrays& targetSums, const PointArrays& s,
                                   const RowRange* ranges, int rangeCount, const PairLimits& limits,
                                   const SumArrays& sourceSums)
{
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

template <PairLaw law> constexpr PairKernels::Law kernelsOf()
{
    return {sumSingle<law>, sumForTargets<law, true>};
}

constexpr PairKernels makeKernels(const char* instructionSet)
{
    return {instructionSet,
            kernelsOf<PairLaw::coulomb>(),
            kernelsOf<PairLaw::withoutDoubleCount>(),
            {kernelsOf<PairLaw::screened1>(), kernelsOf<PairLaw::screened2>()}};
}

}  // namespace
}  // namespace him
