// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/particles_on_mesh.hpp"

#include <algorithm>
#include <numeric>

namespace him {

namespace {

constexpr std::size_t payload = 5;     // position, charge, cell
constexpr std::size_t ownPayload = 6;  // and the tag

}  // namespace

void ParticlesOnMesh::distribute(const MeshLocator& locator, const DemParticles& particles, MeshHalo& halo,
                                 double reach, CloudSources& sources)
{
    SparseExchange& exchange = halo.exchange();
    const auto ranks = static_cast<std::size_t>(exchange.ranks());
    const auto self = static_cast<std::size_t>(exchange.rank());
    sentRows_.resize(ranks);
    targetOf_.resize(ranks);
    exchange.clear(outgoing_);
    for (auto& rows : sentRows_) {
        rows.clear();
    }
    const auto placeInBox = [&](Index row) -> Vector3 {
        const Vector3 place = particles.position.row(row).matrix().transpose();
        return place + locator.shiftIntoBox(place);
    };
    // Nearly all particles are in cells of their own rank: those go into no message.
    targetOfRow_.resize(static_cast<std::size_t>(particles.size()));
    nextOfCell_.assign(static_cast<std::size_t>(halo.mesh().ownCells) + 1, 0);
    for (Index row = 0; row < particles.size(); ++row) {
        const int owner = locator.owner(row);
        std::int32_t& target = targetOfRow_[static_cast<std::size_t>(row)];
        if (owner == exchange.rank()) {
            target = 0;  // its number follows
            ++nextOfCell_[static_cast<std::size_t>(locator.cell(row)) + 1];
        } else if (owner < 0) {
            target = outside;
        } else {
            target = elsewhere;
            const auto rank = static_cast<std::size_t>(owner);
            sentRows_[rank].push_back(row);
            const Vector3 place = placeInBox(row);
            outgoing_[rank].insert(outgoing_[rank].end(),
                                   {place[0], place[1], place[2], particles.charge[row],
                                    static_cast<double>(locator.cell(row)),
                                    static_cast<double>(particles.tag[static_cast<std::size_t>(row)])});
        }
    }
    exchange.exchange(outgoing_, incoming_);

    // Sorted by cell, within a cell by rank, of a rank as they came.
    for (const auto& buffer : incoming_) {
        for (std::size_t at = 0; at < buffer.size(); at += ownPayload) {
            ++nextOfCell_[static_cast<std::size_t>(buffer[at + 4]) + 1];
        }
    }
    std::partial_sum(nextOfCell_.begin(), nextOfCell_.end(), nextOfCell_.begin());
    const Index targets = nextOfCell_.back();
    sources.targets = targets;
    sources.position.resize(targets, 3);
    sources.charge.resize(targets);
    sources.cell.resize(static_cast<std::size_t>(targets));
    tags_.resize(static_cast<std::size_t>(targets));
    const auto take = [&](const Vector3& place, double charge, Index cell, int tag) {
        const Index target = nextOfCell_[static_cast<std::size_t>(cell)]++;
        sources.position.row(target) = place.transpose().array();
        sources.charge[target] = charge;
        sources.cell[static_cast<std::size_t>(target)] = static_cast<std::int32_t>(cell);
        tags_[static_cast<std::size_t>(target)] = tag;
        return target;
    };
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        targetOf_[rank].clear();
        for (std::size_t row = 0; rank == self && row < targetOfRow_.size(); ++row) {
            if (targetOfRow_[row] >= 0) {
                const auto r = static_cast<Index>(row);
                targetOfRow_[row] = static_cast<std::int32_t>(
                    take(placeInBox(r), particles.charge[r], locator.cell(r), particles.tag[row]));
            }
        }
        for (std::size_t at = 0; at < incoming_[rank].size(); at += ownPayload) {
            const double* in = incoming_[rank].data() + at;
            targetOf_[rank].push_back(take(Vector3(in), in[3], static_cast<Index>(in[4]), static_cast<int>(in[5])));
        }
    }
    addCopies(halo, reach, sources);
}

void ParticlesOnMesh::addCopies(MeshHalo& halo, double reach, CloudSources& sources)
{
    if (halo.holders().empty() && halo.exchange().ranks() == 1) {
        return;
    }
    SparseExchange& exchange = halo.exchange();
    exchange.clear(outgoing_);
    for (Index row = 0; row < sources.targets; ++row) {
        const Index cell = sources.cell[static_cast<std::size_t>(row)];
        for (Index n = halo.firstHolder(cell); n < halo.firstHolder(cell + 1); ++n) {
            const MeshHalo::Holder& holder = halo.holders()[static_cast<std::size_t>(n)];
            const auto rank = static_cast<std::size_t>(holder.rank);
            const Vector3 place = sources.position.row(row).matrix().transpose() + holder.shift;
            if (halo.bounds()[rank].squaredDistance(place) <= reach * reach) {
                outgoing_[rank].insert(outgoing_[rank].end(), {place[0], place[1], place[2], sources.charge[row],
                                                               static_cast<double>(holder.copy)});
            }
        }
    }
    exchange.exchange(outgoing_, incoming_);
    Index rows = sources.targets;
    for (const auto& buffer : incoming_) {
        rows += static_cast<Index>(buffer.size() / payload);
    }
    sources.position.conservativeResize(rows, 3);
    sources.charge.conservativeResize(rows);
    Index row = sources.targets;
    for (const auto& buffer : incoming_) {
        for (std::size_t at = 0; at < buffer.size(); at += payload, ++row) {
            sources.position.row(row) << buffer[at], buffer[at + 1], buffer[at + 2];
            sources.charge[row] = buffer[at + 3];
            sources.cell.push_back(static_cast<std::int32_t>(buffer[at + 4]));
        }
    }
}

}  // namespace him
