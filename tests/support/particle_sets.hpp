// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <mpi.h>

namespace him {

/// Spheres at random places that do not overlap, at rest, tags from 1, type 1, mass 1e-6 kg. The same on every rank for the
/// same seed.
/// @param charges  `like`: all `charge`; `mixed`: +-charge in turn; `random`: uniform in +-charge
enum class Charges { like, mixed, random };
DemParticles randomParticles(int count, const Box& box, double diameter, double charge, Charges charges, std::uint32_t seed);

/// `count` particles with every array sized, values zero, tags from 1.
DemParticles emptyParticles(int count);

/// Rows of `all` for which `keep(row)` holds, in their order.
DemParticles select(const DemParticles& all, const std::function<bool(Index)>& keep);

/// This rank's share when particles are dealt out like cards, so that neighbours live on different ranks.
DemParticles dealt(const DemParticles& all, MPI_Comm communicator);

/// One row per tag, from every rank; the same on all ranks. Collective.
std::map<int, Vector3> gatherByTag(const std::vector<int>& tags, const Points& values, MPI_Comm communicator);

}  // namespace him
