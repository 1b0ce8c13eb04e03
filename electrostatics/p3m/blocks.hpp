// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Loops of p3m take four doubles at a time: a wider vector would be taken through memory on machines without AVX-512.

#include "electrostatics/processor_clones.hpp"

#include <cstring>

namespace him {
namespace {

constexpr int blockSize = 4;
using Block = double __attribute__((vector_size(blockSize * sizeof(double))));

inline __attribute__((always_inline)) Block load(const double* from)
{
    Block block;
    std::memcpy(&block, from, sizeof block);
    return block;
}

inline __attribute__((always_inline)) void store(double* to, Block block)
{
    std::memcpy(to, &block, sizeof block);
}

inline __attribute__((always_inline)) double sumOf(Block block)
{
    return (block[0] + block[1]) + (block[2] + block[3]);
}

}  // namespace
}  // namespace him
