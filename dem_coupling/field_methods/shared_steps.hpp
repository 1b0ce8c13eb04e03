// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/mesh_locator.hpp"
#include "dem_coupling/field_method.hpp"

#include <cstdint>
#include <string>

namespace him {

/// Adds a uniform external field E [V/m] to the field of every particle.
void addExternalField(const Vector3& externalField, ParticleField& result);

/// Sets the energy from `result.potential`, which holds the potential of the charges, and adds -E.x [V] to it.
void addExternalPotential(const Vector3& externalField, const DemParticles& particles, ParticleField& result);

/// Sum of `pairs` over all ranks. When a rank's pair sum failed (`failure` not empty), throws on every rank an error that
/// names the two particles at one position. Collective.
/// @param sources  all positions [m] that this rank summed over; the first rows are its own particles
std::int64_t sumPairs(std::int64_t pairs, const std::string& failure, const DemParticles& particles, const Points& sources,
                      MPI_Comm communicator);

/// Counts the particles that no mesh cell holds, and their charge, over all ranks. Collective.
void findOutside(const MeshLocator& locator, const DemParticles& particles, MPI_Comm communicator, ParticleField& result);

/// Throws on every rank an error that names the first of the `count` particles that no mesh cell holds. Collective.
[[noreturn]] void refuseOutside(const std::string& method, const MeshLocator& locator, const DemParticles& particles,
                                std::int64_t count, MPI_Comm communicator);

/// "(x y z) m"
std::string describe(const Vector3& position);

}  // namespace him
