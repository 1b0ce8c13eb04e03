// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/contact_points.hpp"

namespace him {

ContactPoints::ContactPoints(const Points& points, const std::vector<int>& leftOut, MPI_Comm communicator)
    : communicator_(communicator), own_(points.rows())
{
    int ranks = 1;
    int rank = 0;
    MPI_Comm_size(communicator, &ranks);
    MPI_Comm_rank(communicator, &rank);
    const auto mine = static_cast<int>(own_);
    std::vector<int> counts(static_cast<std::size_t>(ranks)), first(static_cast<std::size_t>(ranks), 0);
    MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t r = 1; r < first.size(); ++r) {
        first[r] = first[r - 1] + counts[r - 1];
    }
    first_ = first[static_cast<std::size_t>(rank)];
    const Index all = first.back() + counts.back();
    places_.setZero(all, 3);
    sums_.setZero(all, 3);
    tags_.resize(static_cast<std::size_t>(all));
    if (all == 0) {
        return;
    }
    MPI_Allgatherv(leftOut.data(), mine, MPI_INT, tags_.data(), counts.data(), first.data(), MPI_INT, communicator);
    places_.middleRows(first_, own_) = points;
    MPI_Allreduce(MPI_IN_PLACE, places_.data(), static_cast<int>(places_.size()), MPI_DOUBLE, MPI_SUM, communicator);
}

void ContactPoints::sum(Points& field)
{
    if (size() > 0) {
        MPI_Allreduce(MPI_IN_PLACE, sums_.data(), static_cast<int>(sums_.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    }
    field = sums_.middleRows(first_, own_);
}

}  // namespace him
