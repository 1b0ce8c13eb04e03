// SPDX-License-Identifier: GPL-3.0-or-later
// Counts every malloc and operator new of the near sum; linked with --wrap=malloc.
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"
#include "tests/electrostatics/pair_sums.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

long allocations = 0;

}  // namespace

extern "C" void* __real_malloc(std::size_t bytes);
extern "C" void* __wrap_malloc(std::size_t bytes)
{
    ++allocations;
    return __real_malloc(bytes);
}

void* operator new(std::size_t bytes)
{
    if (void* memory = std::malloc(bytes)) {
        return memory;
    }
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}

namespace him {
namespace {

TEST(NearFieldMemory, isAllocatedOnceForTheLargestNumberOfPoints)
{
    NearField nearField(0.2, epsilon0);
    PairSumResult result;
    ChargedPoints large = randomPoints(1000, 1.0, 1.0, 1.0, 51);
    ChargedPoints moved = randomPoints(1000, 1.0, 1.0, 1.0, 52);
    ChargedPoints smaller = randomPoints(900, 1.0, 1.0, 1.0, 53);
    for (ChargedPoints* points : {&large, &moved, &smaller}) {
        points->targets = 600;
    }
    allocations = 0;
    nearField.coulombWithoutDoubleCount(large, result);
    EXPECT_GT(allocations, 0);  // the counter works

    allocations = 0;
    for (const ChargedPoints* points : {&large, &moved, &smaller, &large}) {
        nearField.coulombWithoutDoubleCount(*points, result);
        nearField.coulomb(*points, result);
        nearField.screened(*points, ChargeCloud(0.2, 2), result);
    }
    EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace him
