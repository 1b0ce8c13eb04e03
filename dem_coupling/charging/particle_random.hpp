// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace him {

/// A standard normal number that belongs to a particle: a function of its tag and a seed alone. It therefore needs no
/// storage, migrates and restarts with the particle and does not depend on the number of ranks.
double normalOfParticle(int tag, std::uint64_t seed);

/// Spread of a property over the particles of a type: mean 0, this standard deviation.
struct ParticleSpread {
    double deviation = 0;  ///< in the unit of the property; 0: none
    std::uint64_t seed = 0;

    double of(int tag) const { return deviation == 0 ? 0 : deviation * normalOfParticle(tag, seed); }
};

}  // namespace him
