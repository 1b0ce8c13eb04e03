// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Several doubles, or twice as many floats, that are computed together. Included by the files of the pair kernels only, each compiled for one
// instruction set, hence the unnamed namespace. Nothing here licenses the compiler to reorder or contract floating point
// operations: contraction is off in these files, and mulAdd says where a fused operation may stand.

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

namespace him {
namespace {

#define HIM_INLINE inline __attribute__((always_inline))

#if defined(__AVX512F__)

constexpr int laneCount = 8;
using Lanes = __m512d;
using LaneMask = __mmask8;

HIM_INLINE Lanes allLanes(double value)
{
    return _mm512_set1_pd(value);
}

/// Consecutive values; all must be readable.
HIM_INLINE Lanes loadLanes(const double* values)
{
    return _mm512_loadu_pd(values);
}

HIM_INLINE void storeLanes(double* values, Lanes lanes)
{
    _mm512_storeu_pd(values, lanes);
}

HIM_INLINE Lanes mulAdd(Lanes a, Lanes b, Lanes c)
{
    return _mm512_fmadd_pd(a, b, c);
}

HIM_INLINE LaneMask firstLanes(std::ptrdiff_t count)
{
    return static_cast<LaneMask>(count >= laneCount ? 0xff : (1 << count) - 1);
}

HIM_INLINE LaneMask atMost(Lanes a, Lanes b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
}

HIM_INLINE Lanes select(LaneMask mask, Lanes yes, Lanes no)
{
    return _mm512_mask_blend_pd(mask, no, yes);
}

HIM_INLINE Lanes zeroUnless(LaneMask mask, Lanes a)
{
    return _mm512_maskz_mov_pd(mask, a);
}

HIM_INLINE int countOf(LaneMask mask)
{
    return __builtin_popcount(mask);
}

/// Relative error below 2^-14 for any normal positive number.
HIM_INLINE Lanes estimateInverseSquareRoot(Lanes a)
{
    return _mm512_maskz_rsqrt14_pd(0xff, a);  // all lanes; the unmasked form warns of its own header
}
constexpr int refinements = 1;

using SingleLanes = __m512;
using SingleMask = __mmask16;

HIM_INLINE SingleLanes allSingleLanes(float value)
{
    return _mm512_set1_ps(value);
}

HIM_INLINE SingleLanes loadLanes(const float* values)
{
    return _mm512_loadu_ps(values);
}

HIM_INLINE void storeLanes(float* values, SingleLanes lanes)
{
    _mm512_storeu_ps(values, lanes);
}

HIM_INLINE SingleLanes mulAdd(SingleLanes a, SingleLanes b, SingleLanes c)
{
    return _mm512_fmadd_ps(a, b, c);
}

HIM_INLINE SingleMask atMost(SingleLanes a, SingleLanes b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}

HIM_INLINE SingleLanes smaller(SingleLanes a, SingleLanes b)
{
    return _mm512_maskz_min_ps(0xffff, a, b);  // all lanes, as above
}

HIM_INLINE SingleLanes larger(SingleLanes a, SingleLanes b)
{
    return _mm512_maskz_max_ps(0xffff, a, b);
}

HIM_INLINE SingleLanes zeroUnless(SingleMask mask, SingleLanes a)
{
    return _mm512_maskz_mov_ps(mask, a);
}

HIM_INLINE int countOf(SingleMask mask)
{
    return __builtin_popcount(mask);
}

HIM_INLINE SingleLanes estimateInverseSquareRoot(SingleLanes a)
{
    return _mm512_maskz_rsqrt14_ps(0xffff, a);
}
constexpr int singleRefinements = 1;

#else

constexpr int laneCount = 4;
using Lanes = double __attribute__((vector_size(laneCount * sizeof(double))));
/// All bits set where a comparison of Lanes holds, else none.
using LaneMask = std::int64_t __attribute__((vector_size(laneCount * sizeof(std::int64_t))));

HIM_INLINE Lanes allLanes(double value)
{
    return Lanes{value, value, value, value};
}

/// Consecutive values; all must be readable.
HIM_INLINE Lanes loadLanes(const double* values)
{
    Lanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

HIM_INLINE void storeLanes(double* values, Lanes lanes)
{
    std::memcpy(values, &lanes, sizeof lanes);
}

HIM_INLINE Lanes mulAdd(Lanes a, Lanes b, Lanes c)
{
#if defined(__FMA__)
    return _mm256_fmadd_pd(a, b, c);
#else
    return a * b + c;
#endif
}

HIM_INLINE LaneMask firstLanes(std::ptrdiff_t count)
{
    const std::int64_t n = count;
    return LaneMask{n, n, n, n} > LaneMask{0, 1, 2, 3};
}

HIM_INLINE LaneMask atMost(Lanes a, Lanes b)
{
    return a <= b;
}

HIM_INLINE Lanes select(LaneMask mask, Lanes yes, Lanes no)
{
    return mask ? yes : no;
}

HIM_INLINE Lanes zeroUnless(LaneMask mask, Lanes a)
{
    return mask ? a : Lanes{};
}

HIM_INLINE int countOf(LaneMask mask)
{
#if defined(__AVX2__)
    return __builtin_popcount(static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask))));
#else
    return static_cast<int>(-((mask[0] + mask[1]) + (mask[2] + mask[3])));
#endif
}

/// Halves the exponent through the bits; relative error below 0.035 for any normal positive number.
HIM_INLINE Lanes estimateInverseSquareRoot(Lanes a)
{
    using Bits = std::uint64_t __attribute__((vector_size(laneCount * sizeof(std::uint64_t))));
    Bits bits;
    std::memcpy(&bits, &a, sizeof bits);
    bits = 0x5fe6eb50c7b537a9ull - (bits >> 1);
    std::memcpy(&a, &bits, sizeof a);
    return a;
}
constexpr int refinements = 2;

using SingleLanes = float __attribute__((vector_size(8 * sizeof(float))));
using SingleMask = std::int32_t __attribute__((vector_size(8 * sizeof(std::int32_t))));

HIM_INLINE SingleLanes allSingleLanes(float value)
{
    return SingleLanes{value, value, value, value, value, value, value, value};
}

HIM_INLINE SingleLanes loadLanes(const float* values)
{
    SingleLanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

HIM_INLINE void storeLanes(float* values, SingleLanes lanes)
{
    std::memcpy(values, &lanes, sizeof lanes);
}

HIM_INLINE SingleLanes mulAdd(SingleLanes a, SingleLanes b, SingleLanes c)
{
#if defined(__FMA__)
    return _mm256_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}

HIM_INLINE SingleMask atMost(SingleLanes a, SingleLanes b)
{
    return a <= b;
}

HIM_INLINE SingleLanes smaller(SingleLanes a, SingleLanes b)
{
#if defined(__AVX2__)
    return _mm256_min_ps(a, b);
#else
    return a < b ? a : b;
#endif
}

HIM_INLINE SingleLanes larger(SingleLanes a, SingleLanes b)
{
#if defined(__AVX2__)
    return _mm256_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}

HIM_INLINE SingleLanes zeroUnless(SingleMask mask, SingleLanes a)
{
    return mask ? a : SingleLanes{};
}

HIM_INLINE int countOf(SingleMask mask)
{
#if defined(__AVX2__)
    return __builtin_popcount(static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask))));
#else
    return static_cast<int>(
        -(((mask[0] + mask[1]) + (mask[2] + mask[3])) + ((mask[4] + mask[5]) + (mask[6] + mask[7]))));
#endif
}

#if defined(__AVX2__)
/// Relative error below 1.5 times 2^-12 for any normal positive number.
HIM_INLINE SingleLanes estimateInverseSquareRoot(SingleLanes a)
{
    return _mm256_rsqrt_ps(a);
}
constexpr int singleRefinements = 1;
#else
HIM_INLINE SingleLanes estimateInverseSquareRoot(SingleLanes a)
{
    using Bits = std::uint32_t __attribute__((vector_size(8 * sizeof(std::uint32_t))));
    Bits bits;
    std::memcpy(&bits, &a, sizeof bits);
    bits = 0x5f375a86u - (bits >> 1);
    std::memcpy(&a, &bits, sizeof a);
    return a;
}
constexpr int singleRefinements = 2;
#endif

#endif

constexpr int singleLaneCount = 2 * laneCount;

HIM_INLINE Lanes broadcastLike(Lanes, double value)
{
    return allLanes(value);
}

HIM_INLINE SingleLanes broadcastLike(SingleLanes, double value)
{
    return allSingleLanes(static_cast<float>(value));
}

template <class AnyLanes> HIM_INLINE AnyLanes mulAdd(AnyLanes a, AnyLanes b, double c)
{
    return mulAdd(a, b, broadcastLike(a, c));
}

/// 1/sqrt(a) to a few units of round-off, for normal positive numbers. With h = 1 - a y^2 the exact value is
/// y (1 - h)^(-1/2), and the series up to h^3 leaves 0.27 h^4.
HIM_INLINE Lanes inverseSquareRoot(Lanes a)
{
    Lanes y = estimateInverseSquareRoot(a);
    for (int n = 0; n < refinements; ++n) {
        const Lanes h = mulAdd(-(a * y), y, 1.0);
        const Lanes series = mulAdd(mulAdd(h, allLanes(0.3125), 0.375), h, 0.5);
        y = mulAdd(y * h, series, y);
    }
    return y;
}

/// The same; the series up to h^2 is enough for 24 bits.
HIM_INLINE SingleLanes inverseSquareRoot(SingleLanes a)
{
    SingleLanes y = estimateInverseSquareRoot(a);
    for (int n = 0; n < singleRefinements; ++n) {
        const SingleLanes h = mulAdd(-(a * y), y, 1.0);
        y = mulAdd(y * h, mulAdd(h, allSingleLanes(0.375F), 0.5), y);
    }
    return y;
}

template <int count, class AnyLanes> HIM_INLINE auto sumOfLanes(AnyLanes a)
{
    decltype(a[0] + a[0]) sum = 0;
    for (int lane = 0; lane < count; lane += 4) {
        sum += (a[lane] + a[lane + 1]) + (a[lane + 2] + a[lane + 3]);
    }
    return sum;
}

HIM_INLINE double sumOf(Lanes a)
{
    return sumOfLanes<laneCount>(a);
}

HIM_INLINE float sumOf(SingleLanes a)
{
    return sumOfLanes<singleLaneCount>(a);
}

}  // namespace
}  // namespace him
