// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/particle_faults.hpp"

#include "dem_coupling/exchange/sparse_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

constexpr int mostNamed = 10;

std::string words(const Vector3& vector)
{
    std::ostringstream text;
    text << '(' << vector[0] << ' ' << vector[1] << ' ' << vector[2] << ')';
    return text.str();
}

/// All ranks' tags on rank 0, sorted; empty elsewhere.
std::vector<int> gatherTags(const std::vector<int>& tags, const SparseExchange& ranks)
{
    const int mine = static_cast<int>(tags.size());
    std::vector<int> counts(static_cast<std::size_t>(ranks.ranks()));
    MPI_Gather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, ranks.communicator());
    std::vector<int> offsets(counts.size(), 0);
    for (std::size_t r = 1; r < counts.size(); ++r) {
        offsets[r] = offsets[r - 1] + counts[r - 1];
    }
    std::vector<int> all(ranks.rank() == 0 ? static_cast<std::size_t>(offsets.back() + counts.back()) : 0);
    MPI_Gatherv(tags.data(), mine, MPI_INT, all.data(), counts.data(), offsets.data(), MPI_INT, 0,
                ranks.communicator());
    std::sort(all.begin(), all.end());
    return all;
}

/// Position and velocity of a few tags, wherever they are. Collective.
std::vector<double> statesOf(const std::vector<int>& tags, const DemParticles& particles, MPI_Comm communicator)
{
    std::vector<double> states(6 * tags.size(), 0.0);
    for (std::size_t n = 0; n < tags.size(); ++n) {
        const auto found = std::find(particles.tag.begin(), particles.tag.end(), tags[n]);
        if (found != particles.tag.end()) {
            const Index row = found - particles.tag.begin();
            for (int axis = 0; axis < 3; ++axis) {
                states[6 * n + static_cast<std::size_t>(axis)] = particles.position(row, axis);
                states[6 * n + static_cast<std::size_t>(axis) + 3] = particles.velocity(row, axis);
            }
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, states.data(), static_cast<int>(states.size()), MPI_DOUBLE, MPI_SUM, communicator);
    return states;
}

bool finite(const Points& points, Index row)
{
    return points.row(row).isFinite().all();
}

/// Where the particle of that tag was at the last field update, if this rank had it.
std::string lastSeen(int tag, const DemParticles& before)
{
    const auto found = std::find(before.tag.begin(), before.tag.end(), tag);
    if (found == before.tag.end()) {
        return "";
    }
    const Index row = found - before.tag.begin();
    return "; at the last field update it was at " + words(before.position.row(row).matrix().transpose())
           + " m with velocity " + words(before.velocity.row(row).matrix().transpose()) + " m/s";
}

}  // namespace

void throwOnLostParticles(const DemParticles& now, const DemParticles& before, std::int64_t believed,
                          MPI_Comm communicator)
{
    const SparseExchange ranks(communicator);
    const std::vector<int> tagsNow = gatherTags(now.tag, ranks);
    const std::vector<int> tagsBefore = gatherTags(before.tag, ranks);
    std::vector<int> missing;
    std::set_difference(tagsBefore.begin(), tagsBefore.end(), tagsNow.begin(), tagsNow.end(),
                        std::back_inserter(missing));
    std::array<int, 3> sizes{static_cast<int>(tagsNow.size()), static_cast<int>(missing.size()),
                             std::min(static_cast<int>(missing.size()), mostNamed)};
    MPI_Bcast(sizes.data(), 3, MPI_INT, 0, communicator);
    missing.resize(static_cast<std::size_t>(sizes[2]));
    MPI_Bcast(missing.data(), sizes[2], MPI_INT, 0, communicator);
    const std::vector<double> states = statesOf(missing, before, communicator);

    std::ostringstream text;
    text << "the DEM believes to have " << believed << " particles, and " << sizes[0] << " are there.";
    for (std::size_t n = 0; n < missing.size(); ++n) {
        const double* state = states.data() + 6 * n;
        text << "\n  missing: particle " << missing[n] << ", last at " << words(Vector3(state[0], state[1], state[2]))
             << " m with velocity " << words(Vector3(state[3], state[4], state[5])) << " m/s";
    }
    if (sizes[1] > sizes[2]) {
        text << "\n  and " << sizes[1] - sizes[2] << " more";
    }
    text << "\nCheck the DEM `timestep` (a particle may have passed through a wall), that the walls are closed, and "
            "that the"
            " DEM box is larger than the walls or its `boundary` is not f where particles may leave";
    throw std::runtime_error(text.str());
}

std::int64_t countBadParticles(const DemParticles& particles)
{
    std::int64_t bad = 0;
    for (Index row = 0; row < particles.size(); ++row) {
        bad += !(finite(particles.position, row) && finite(particles.velocity, row)
                 && std::isfinite(particles.charge[row]));
    }
    return bad;
}

void throwOnBadParticles(const DemParticles& now, const DemParticles& before, MPI_Comm communicator)
{
    int tag = nothingToSay;
    std::string text;
    for (Index row = 0; row < now.size(); ++row) {
        const bool place = finite(now.position, row);
        const bool speed = finite(now.velocity, row);
        const int candidate = now.tag[static_cast<std::size_t>(row)];
        if (candidate >= tag || (place && speed && std::isfinite(now.charge[row]))) {
            continue;
        }
        tag = candidate;
        std::ostringstream line;
        line << "particle " << tag << ": its "
             << (!place   ? "position"
                 : !speed ? "velocity"
                          : "charge")
             << " is not a finite number; position " << words(now.position.row(row).matrix().transpose())
             << " m, velocity " << words(now.velocity.row(row).matrix().transpose()) << " m/s, charge "
             << now.charge[row] << " C" << lastSeen(tag, before) << ". Check "
             << (place && speed
                     ? "gamma and kappa of the charging fix in the DEM script"
                     : "the DEM `timestep` and the stiffness of the materials in the DEM script, and particles "
                       "that overlap when they are created");
        text = line.str();
    }
    throwTogether(communicator, tag, text);
}

std::int64_t countBadFields(const Points& field)
{
    std::int64_t bad = 0;
    for (Index row = 0; row < field.rows(); ++row) {
        bad += !finite(field, row);
    }
    return bad;
}

void throwOnBadFields(const DemParticles& particles, const Points& field, MPI_Comm communicator)
{
    int tag = nothingToSay;
    std::string text;
    for (Index row = 0; row < field.rows(); ++row) {
        const int candidate = particles.tag[static_cast<std::size_t>(row)];
        if (candidate < tag && !finite(field, row)) {
            tag = candidate;
            text = "particle " + std::to_string(tag) + " at " + words(particles.position.row(row).matrix().transpose())
                   + " m: the electric field " + words(field.row(row).matrix().transpose())
                   + " V/m is not finite. Check the boundary values of 0/electricPotential, its solver in "
                     "system/fvSolution, "
                     "and externalField in constant/electrostaticProperties";
        }
    }
    throwTogether(communicator, tag, text);
}

void stopOnOpenBooks(const ChargeBooks& books)
{
    if (std::fabs(books.relativeClosureError()) <= ChargeBooks::tolerance) {
        return;
    }
    const ChargeMovements& moved = books.movements();
    std::ostringstream text;
    text.precision(12);
    text << "the charge books do not close: " << books.closureError() << " C on the particles has no entry ("
         << books.relativeClosureError() << " of all charge, allowed " << ChargeBooks::tolerance << ").\n  particles "
         << books.particleCharge() << " C, inserted " << moved.inserted << " C, removed " << moved.removed
         << " C, leaked " << moved.leaked << " C, breakdown " << moved.breakdown << " C";
    for (std::size_t wall = 0; wall < moved.toWall.size(); ++wall) {
        text << ", to wall " << wall + 1 << ' ' << moved.toWall[wall] << " C";
    }
    text << ".\nSomething other than contacts changed particle charges: look in the DEM script for a fix or variable "
            "that sets "
            "`charge` after the hand-over";
    throw std::runtime_error(text.str());
}

}  // namespace him
