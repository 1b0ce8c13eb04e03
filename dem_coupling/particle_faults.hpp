// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charge_books.hpp"
#include "dem_coupling/dem_port.hpp"

#include <cstdint>

namespace him {

// What stops a coupled run, in words. The functions that throw are collective and throw the same std::runtime_error on
// every rank; call them once all ranks know that something is wrong.

/// Names particles that are in no rank's `now` but were in some rank's `before`, with their last position and velocity;
/// `believed` is the number that the DEM thinks it has.
[[noreturn]] void throwOnLostParticles(const DemParticles& now, const DemParticles& before, std::int64_t believed,
                                       MPI_Comm communicator);

/// Rows of this rank whose position, velocity or charge is not finite. Not collective.
std::int64_t countBadParticles(const DemParticles& particles);
/// Names the bad particle with the lowest tag, what is not finite, and where it was last.
[[noreturn]] void throwOnBadParticles(const DemParticles& now, const DemParticles& before, MPI_Comm communicator);

/// Rows of this rank whose field is not finite. Not collective.
std::int64_t countBadFields(const Points& field);
[[noreturn]] void throwOnBadFields(const DemParticles& particles, const Points& field, MPI_Comm communicator);

/// Throws std::runtime_error with every line of the books when they do not close to ChargeBooks::tolerance. The books
/// hold global sums, so every rank decides alike.
void stopOnOpenBooks(const ChargeBooks& books);

}  // namespace him
