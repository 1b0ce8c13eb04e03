// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/shared_steps.hpp"

#include "dem_coupling/exchange/sparse_exchange.hpp"
#include "electrostatics/near_field.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace him {

void addExternalField(const Vector3& externalField, ParticleField& result)
{
    result.field.rowwise() += externalField.transpose().array();
}

void addExternalPotential(const Vector3& externalField, const DemParticles& particles, ParticleField& result)
{
    result.energy = electrostaticEnergy(particles.charge, result.potential);
    if (!externalField.isZero(0)) {
        const Scalars external = -(particles.position.matrix() * externalField).array();
        result.potential += external;
        result.energy += (particles.charge * external).sum();
    }
}

namespace {

/// Text and tag for the first own particle that shares its position with another source.
struct Coincidence {
    int tag = nothingToSay;
    std::string text;
};

Coincidence findCoincidence(const DemParticles& particles, const Points& sources)
{
    std::vector<Index> order(static_cast<std::size_t>(sources.rows()));
    std::iota(order.begin(), order.end(), Index{0});
    const auto before = [&](Index a, Index b) {
        for (int axis = 0; axis < 3; ++axis) {
            if (sources(a, axis) != sources(b, axis)) {
                return sources(a, axis) < sources(b, axis);
            }
        }
        return false;
    };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return before(a, b) || (!before(b, a) && a < b); });
    for (std::size_t n = 1; n < order.size(); ++n) {
        const Index row = order[n - 1];
        const Index other = order[n];
        if (row < particles.size() && !before(row, other)) {
            const bool ownToo = other < particles.size();
            return {particles.tag[static_cast<std::size_t>(row)],
                    "particle " + std::to_string(particles.tag[static_cast<std::size_t>(row)]) + " and "
                        + (ownToo ? "particle " + std::to_string(particles.tag[static_cast<std::size_t>(other)])
                                  : std::string("a particle of another rank or a periodic copy"))
                        + " are at the same position, " + describe(particles.position.row(row).matrix().transpose())};
        }
    }
    return {};
}

}  // namespace

std::int64_t sumPairs(std::int64_t pairs, const std::string& failure, const DemParticles& particles, const Points& sources,
                      MPI_Comm communicator)
{
    const std::int64_t mine[2] = {pairs, failure.empty() ? 0 : 1};
    std::int64_t all[2] = {0, 0};
    MPI_Allreduce(mine, all, 2, MPI_INT64_T, MPI_SUM, communicator);
    if (all[1] == 0) {
        return all[0];
    }
    Coincidence found = findCoincidence(particles, sources);
    if (found.text.empty() && !failure.empty()) {
        found = {nothingToSay - 1, failure};
    }
    throwTogether(communicator, found.tag,
                  "field: " + found.text + ", so their Coulomb field is infinite. Check the DEM script for particles that are "
                  "created twice, and the DEM time step");
}

void findOutside(const MeshLocator& locator, const DemParticles& particles, MPI_Comm communicator, ParticleField& result)
{
    double mine[2] = {0, 0};
    for (Index row = 0; row < particles.size(); ++row) {
        if (!locator.inMesh(row)) {
            mine[0] += 1;
            mine[1] += particles.charge[row];
        }
    }
    double all[2] = {0, 0};
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, communicator);
    result.excludedCount = static_cast<std::int64_t>(all[0]);
    result.excludedCharge = all[1];
}

void refuseOutside(const std::string& method, const MeshLocator& locator, const DemParticles& particles, std::int64_t count,
                   MPI_Comm communicator)
{
    int tag = nothingToSay;
    std::string text;
    for (Index row = 0; row < particles.size(); ++row) {
        if (!locator.inMesh(row) && particles.tag[static_cast<std::size_t>(row)] < tag) {
            tag = particles.tag[static_cast<std::size_t>(row)];
            text = "field method " + method + ": particle " + std::to_string(tag) + " at "
                   + describe(particles.position.row(row).matrix().transpose()) + " is in no cell of the mesh"
                   + (count > 1 ? " (" + std::to_string(count) + " particles are not)" : "")
                   + ". Make the mesh cover all the space that the DEM walls leave to particles, or set "
                     "couplingProperties.particlesOutsideMesh to excluded: such particles then neither give charge to the "
                     "mesh nor see its field";
        }
    }
    throwTogether(communicator, tag, text);
}

std::string describe(const Vector3& position)
{
    std::ostringstream text;
    text << '(' << position[0] << ' ' << position[1] << ' ' << position[2] << ") m";
    return text.str();
}

}  // namespace him
