// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/pair_kernels.hpp"

#include "electrostatics/lanes.hpp"

// One binary serves every x86-64 processor: the loader picks the widest version that the machine has.
#if defined(__x86_64__) && defined(__GNUC__)
#define HIM_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HIM_CLONES
#endif

namespace him {

namespace {

struct LaneVector {
    Lanes x, y, z;
};

HIM_INLINE LaneVector spread(const Vector3& v)
{
    return {allLanes(v.x()), allLanes(v.y()), allLanes(v.z())};
}

/// From four sources to the target.
HIM_INLINE LaneVector separation(const LaneVector& target, const double* x, const double* y, const double* z)
{
    return {target.x - loadLanes(x), target.y - loadLanes(y), target.z - loadLanes(z)};
}

HIM_INLINE Lanes squaredLength(const LaneVector& d)
{
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// 1 / r^3 where the mask holds and 0 elsewhere. The denominator is blended before the division: no lane divides by 0.
HIM_INLINE Lanes inverseCube(LaneMask mask, Lanes squaredDistance)
{
    const Lanes safe = mask ? squaredDistance : allLanes(1.0);
    const Lanes one = mask ? allLanes(1.0) : allLanes(0.0);
    return one / (safe * squareRoot(safe));
}

HIM_INLINE void subtractAt(double* values, Lanes change)
{
    storeLanes(values, loadLanes(values) - change);
}

enum class PairLaw { coulomb, withoutDoubleCount, screened };

template <PairLaw law, bool mutual>
HIM_INLINE PairSum sumOverRanges(const SourceArrays& s, const RowRange* ranges, int rangeCount,
                                 const PairTarget& target, const PairLimits& limits,
                                 const ChargeCloud::Coefficients& cloud, const ReactionArrays& reaction)
{
    constexpr bool withoutDoubleCount = law == PairLaw::withoutDoubleCount;
    constexpr bool screened = law == PairLaw::screened;
    const LaneVector position = spread(target.position);
    const LaneVector cell = spread(target.cellCentre);
    const Lanes ownCharge = allLanes(target.charge);
    LaneVector field{};
    Lanes potential{};
    LaneMask pairs{};
    LaneMask coincident{};
    for (int i = 0; i < rangeCount; ++i) {
        const Index end = ranges[i].end;
        // Rows left in the range, counted from each lane: positive where the lane holds a row of the range.
        Lanes left = allLanes(static_cast<double>(end - ranges[i].begin)) - Lanes{0, 1, 2, 3};
        for (Index k = ranges[i].begin; k < end; k += laneCount, left -= double(laneCount)) {
            const LaneVector d = separation(position, s.x + k, s.y + k, s.z + k);
            const Lanes r2 = squaredLength(d);
            const LaneMask within = (left > 0.0) & (r2 <= limits.cutoffSquared);
            const LaneMask same = within & (r2 <= smallestDistance * smallestDistance);
            const LaneMask counts = within & ~same;
            pairs -= counts;  // a true mask is -1
            coincident |= same;

            // Field of a unit charge at the source, at the target.
            Lanes weight = inverseCube(counts, r2);
            Lanes unitPotential = weight * r2;
            if constexpr (screened) {
                const Lanes u2 = (counts ? r2 : allLanes(limits.cutoffSquared)) * cloud.inverseSquaredRadius;
                const auto& f = cloud.field;
                const auto& p = cloud.potential;
                const Lanes cloudField = f[0] + u2 * (f[1] + u2 * f[2]);
                const Lanes cloudPotential = p[0] + u2 * (p[1] + u2 * (p[2] + u2 * p[3]));
                weight -= counts ? cloudField : allLanes(0.0);
                unitPotential -= counts ? cloudPotential : allLanes(0.0);
            }
            LaneVector unit{weight * d.x, weight * d.y, weight * d.z};
            if constexpr (withoutDoubleCount) {
                const LaneVector cellD = separation(cell, s.cellX + k, s.cellY + k, s.cellZ + k);
                const Lanes cellR2 = squaredLength(cellD);
                const Lanes cellWeight = inverseCube(counts & (cellR2 > limits.sameCellSquared), cellR2);
                unit.x -= cellWeight * cellD.x;
                unit.y -= cellWeight * cellD.y;
                unit.z -= cellWeight * cellD.z;
            }
            const Lanes charge = loadLanes(s.q + k);
            field.x += charge * unit.x;
            field.y += charge * unit.y;
            field.z += charge * unit.z;
            if constexpr (mutual) {
                subtractAt(reaction.x + k, ownCharge * unit.x);
                subtractAt(reaction.y + k, ownCharge * unit.y);
                subtractAt(reaction.z + k, ownCharge * unit.z);
            }
            if constexpr (!withoutDoubleCount) {
                potential += charge * unitPotential;
                if constexpr (mutual) {
                    subtractAt(reaction.potential + k, -ownCharge * unitPotential);
                }
            }
        }
    }
    return {Vector3(sumOf(field.x), sumOf(field.y), sumOf(field.z)), sumOf(potential), sumOf(pairs),
            sumOf(coincident) != 0};
}

}  // namespace

HIM_CLONES PairSum sumCoulomb(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                              const PairTarget& target, const PairLimits& limits)
{
    return sumOverRanges<PairLaw::coulomb, false>(sources, ranges, rangeCount, target, limits, {}, {});
}

HIM_CLONES PairSum sumMutualCoulomb(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                                    const PairTarget& target, const PairLimits& limits, const ReactionArrays& reaction)
{
    return sumOverRanges<PairLaw::coulomb, true>(sources, ranges, rangeCount, target, limits, {}, reaction);
}

HIM_CLONES PairSum sumWithoutDoubleCount(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                                         const PairTarget& target, const PairLimits& limits)
{
    return sumOverRanges<PairLaw::withoutDoubleCount, false>(sources, ranges, rangeCount, target, limits, {}, {});
}

HIM_CLONES PairSum sumMutualWithoutDoubleCount(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                                               const PairTarget& target, const PairLimits& limits,
                                               const ReactionArrays& reaction)
{
    return sumOverRanges<PairLaw::withoutDoubleCount, true>(sources, ranges, rangeCount, target, limits, {}, reaction);
}

HIM_CLONES PairSum sumScreened(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                               const PairTarget& target, const PairLimits& limits,
                               const ChargeCloud::Coefficients& cloud)
{
    return sumOverRanges<PairLaw::screened, false>(sources, ranges, rangeCount, target, limits, cloud, {});
}

HIM_CLONES PairSum sumMutualScreened(const SourceArrays& sources, const RowRange* ranges, int rangeCount,
                                     const PairTarget& target, const PairLimits& limits,
                                     const ChargeCloud::Coefficients& cloud, const ReactionArrays& reaction)
{
    return sumOverRanges<PairLaw::screened, true>(sources, ranges, rangeCount, target, limits, cloud, reaction);
}

}  // namespace him
