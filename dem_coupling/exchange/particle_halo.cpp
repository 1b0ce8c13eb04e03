// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/particle_halo.hpp"

#include <cmath>

namespace him {

namespace {

constexpr Index payload = 7;  // position, charge, cell centre

}  // namespace

ParticleHalo::ParticleHalo(double cutoff, const Box& demBox, const std::array<bool, 3>& periodic, MPI_Comm communicator)
    : cutoff_(cutoff * (1 + 1e-12)),  // a pair at the cutoff must not be lost to the rounding of a periodic shift
      period_(demBox.size()),
      periodic_(periodic),
      exchange_(communicator),
      bounds_(static_cast<std::size_t>(exchange_.ranks())),
      copies_(static_cast<std::size_t>(exchange_.ranks()))
{
}

void ParticleHalo::shareBounds(const Points& positions)
{
    Box own;
    if (positions.rows() > 0) {
        own.lower = positions.colwise().minCoeff().transpose();
        own.upper = positions.colwise().maxCoeff().transpose();
    }
    static_assert(sizeof(Box) == 6 * sizeof(double), "a box travels as six doubles");
    MPI_Allgather(own.lower.data(), 6, MPI_DOUBLE, bounds_.data(), 6, MPI_DOUBLE, exchange_.communicator());
}

void ParticleHalo::chooseCopies(const Points& positions)
{
    const Box& own = bounds_[static_cast<std::size_t>(exchange_.rank())];
    for (int rank = 0; rank < exchange_.ranks(); ++rank) {
        auto& copies = copies_[static_cast<std::size_t>(rank)];
        copies.clear();
        const Box reach = bounds_[static_cast<std::size_t>(rank)].grownBy(cutoff_);
        if (reach.empty() || own.empty()) {
            continue;
        }
        // Shifts by n periods for which this rank's box can touch what the other one reaches.
        std::array<int, 3> first{}, last{};
        for (int axis = 0; axis < 3; ++axis) {
            if (periodic_[static_cast<std::size_t>(axis)]) {
                first[axis] = static_cast<int>(std::ceil((reach.lower[axis] - own.upper[axis]) / period_[axis]));
                last[axis] = static_cast<int>(std::floor((reach.upper[axis] - own.lower[axis]) / period_[axis]));
            }
        }
        for (int i = first[0]; i <= last[0]; ++i) {
            for (int j = first[1]; j <= last[1]; ++j) {
                for (int k = first[2]; k <= last[2]; ++k) {
                    const Vector3 shift = Vector3(i, j, k).cwiseProduct(period_);
                    const bool itself = rank == exchange_.rank() && i == 0 && j == 0 && k == 0;
                    if (itself || !reach.overlaps(Box{own.lower + shift, own.upper + shift})) {
                        continue;
                    }
                    for (Index row = 0; row < positions.rows(); ++row) {
                        const Vector3 copy = positions.row(row).matrix().transpose() + shift;
                        if (bounds_[static_cast<std::size_t>(rank)].squaredDistance(copy) <= cutoff_ * cutoff_) {
                            copies.push_back({row, shift});
                        }
                    }
                }
            }
        }
    }
}

void ParticleHalo::extend(ChargedPoints& points)
{
    const Index own = points.position.rows();
    shareBounds(points.position);
    chooseCopies(points.position);

    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < copies_.size(); ++rank) {
        for (const Copy& copy : copies_[rank]) {
            const Vector3 position = points.position.row(copy.row).matrix().transpose() + copy.shift;
            const Vector3 centre = points.cellCentre.row(copy.row).matrix().transpose() + copy.shift;
            outgoing_[rank].insert(outgoing_[rank].end(), {position[0], position[1], position[2],
                                                           points.charge[copy.row], centre[0], centre[1], centre[2]});
        }
    }
    exchange_.exchange(outgoing_, incoming_);

    Index rows = own;
    for (const auto& buffer : incoming_) {
        rows += static_cast<Index>(buffer.size()) / payload;
    }
    points.targets = own;
    points.position.conservativeResize(rows, 3);
    points.charge.conservativeResize(rows);
    points.cellCentre.conservativeResize(rows, 3);
    Index row = own;
    for (const auto& buffer : incoming_) {
        for (std::size_t at = 0; at < buffer.size(); at += payload, ++row) {
            points.position.row(row) << buffer[at], buffer[at + 1], buffer[at + 2];
            points.charge[row] = buffer[at + 3];
            points.cellCentre.row(row) << buffer[at + 4], buffer[at + 5], buffer[at + 6];
        }
    }
}

void ParticleHalo::forward(Scalars& values)
{
    const Index own = values.size();
    exchange_.clear(forwardedOut_);
    exchange_.clear(forwardedIn_);
    Index rows = own;
    for (std::size_t rank = 0; rank < copies_.size(); ++rank) {
        for (const Copy& copy : copies_[rank]) {
            forwardedOut_[rank].push_back(values[copy.row]);
        }
        forwardedIn_[rank].resize(incoming_[rank].size() / payload);
        rows += static_cast<Index>(forwardedIn_[rank].size());
    }
    exchange_.answer(forwardedOut_, forwardedIn_);

    values.conservativeResize(rows);
    Index row = own;
    for (const auto& buffer : forwardedIn_) {
        for (const double value : buffer) {
            values[row++] = value;
        }
    }
}

}  // namespace him
