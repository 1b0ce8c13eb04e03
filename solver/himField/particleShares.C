// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/particleShares.H"

#include <limits>

namespace him {

namespace {

constexpr int nobody = std::numeric_limits<int>::max();

/// Rank 0's values on every rank.
void share(Scalars& values, Index size, MPI_Comm communicator)
{
    values.resize(size);
    MPI_Bcast(values.data(), static_cast<int>(size), MPI_DOUBLE, 0, communicator);
}

/// Rank that gets each row: the lowest one whose mesh holds it; `nobody` when none does.
std::vector<int> ownersInMesh(const Points& positions, const PoissonMesh& mesh, MPI_Comm communicator)
{
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    std::vector<int> owner(static_cast<std::size_t>(positions.rows()), nobody);
    for (Index row = 0; row < positions.rows(); ++row) {
        if (mesh.findCell(positions.row(row).matrix().transpose()) >= 0) {
            owner[static_cast<std::size_t>(row)] = rank;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, owner.data(), static_cast<int>(owner.size()), MPI_INT, MPI_MIN, communicator);
    return owner;
}

std::vector<int> equalShares(Index size, int ranks)
{
    std::vector<int> owner(static_cast<std::size_t>(size));
    for (std::size_t row = 0; row < owner.size(); ++row) {
        owner[row] = static_cast<int>(row * static_cast<std::size_t>(ranks) / owner.size());
    }
    return owner;
}

}  // namespace

particleShares::particleShares(const particleTable& table, const PoissonMesh* mesh, MPI_Comm communicator)
    : communicator_(communicator)
{
    int ranks = 1;
    MPI_Comm_rank(communicator, &rank_);
    MPI_Comm_size(communicator, &ranks);
    long size[2] = {static_cast<long>(table.size()), static_cast<long>(table.radius.size())};
    MPI_Bcast(size, 2, MPI_LONG, 0, communicator);
    total_ = size[0];

    Points position = table.position;
    Scalars charge = table.charge, radius = table.radius, coordinate;
    position.conservativeResize(total_, 3);
    for (int axis = 0; axis < 3; ++axis) {
        coordinate = position.col(axis);
        share(coordinate, total_, communicator);
        position.col(axis) = coordinate;
    }
    share(charge, total_, communicator);
    share(radius, size[1], communicator);

    std::vector<int> owner = mesh ? ownersInMesh(position, *mesh, communicator) : equalShares(total_, ranks);
    counts_.assign(static_cast<std::size_t>(ranks), 0);
    std::vector<Index> mine;
    for (Index row = 0; row < total_; ++row) {
        int& rank = owner[static_cast<std::size_t>(row)];
        if (rank == nobody) {
            outside_.push_back(row);
            rank = 0;
        }
        ++counts_[static_cast<std::size_t>(rank)];
        if (rank == rank_) {
            mine.push_back(row);
        }
    }
    const auto count = static_cast<Index>(mine.size());
    own_.position.resize(count, 3);
    own_.velocity = Points::Zero(count, 3);
    own_.charge.resize(count);
    own_.radius = Scalars::Zero(count);
    own_.mass = Scalars::Zero(count);
    own_.type.assign(mine.size(), 1);
    for (Index n = 0; n < count; ++n) {
        const Index row = mine[static_cast<std::size_t>(n)];
        own_.tag.push_back(static_cast<int>(row) + 1);
        own_.position.row(n) = position.row(row);
        own_.charge[n] = charge[row];
        if (size[1] > 0) {
            own_.radius[n] = radius[row];
        }
    }

    starts_.assign(counts_.size(), 0);
    for (std::size_t rank = 1; rank < counts_.size(); ++rank) {
        starts_[rank] = starts_[rank - 1] + counts_[rank - 1];
    }
    std::vector<int> next = starts_;
    rows_.resize(owner.size());
    for (std::size_t row = 0; row < owner.size(); ++row) {
        rows_[static_cast<std::size_t>(next[static_cast<std::size_t>(owner[row])]++)] = static_cast<int>(row);
    }
}

Scalars particleShares::gathered(const Scalars& values) const
{
    Scalars arrived(rank_ == 0 ? total_ : 0);
    MPI_Gatherv(values.data(), static_cast<int>(values.size()), MPI_DOUBLE, arrived.data(), counts_.data(),
                starts_.data(), MPI_DOUBLE, 0, communicator_);
    Scalars inOrder(arrived.size());
    for (Index n = 0; n < arrived.size(); ++n) {
        inOrder[rows_[static_cast<std::size_t>(n)]] = arrived[n];
    }
    return inOrder;
}

Points particleShares::gathered(const Points& values) const
{
    Points all(rank_ == 0 ? total_ : 0, 3);
    for (int axis = 0; axis < 3; ++axis) {
        all.col(axis) = gathered(Scalars(values.col(axis)));
    }
    return all;
}

}  // namespace him
