// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/particle_random.hpp"

#include "electrostatics/constants.hpp"

#include <cmath>

namespace him {
namespace {

/// Finaliser of splitmix64 (Steele, Lea, Flood 2014, doi 10.1145/2660193.2660195): every input bit changes every output bit.
std::uint64_t mixed(std::uint64_t x)
{
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30u)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27u)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31u);
}

/// In (0, 1): never 0, whose logarithm is infinite.
double uniform(std::uint64_t bits)
{
    return (static_cast<double>(bits >> 11u) + 0.5) * 0x1p-53;
}

}  // namespace

double normalOfParticle(int tag, std::uint64_t seed)
{
    const std::uint64_t first = mixed(mixed(seed) + static_cast<std::uint64_t>(tag));
    const std::uint64_t second = mixed(first);
    return std::sqrt(-2.0 * std::log(uniform(first))) * std::cos(2.0 * pi * uniform(second));  // Box and Muller
}

}  // namespace him
