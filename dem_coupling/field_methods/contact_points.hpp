// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <mpi.h>
#include <vector>

namespace him {

/// Contact points of all ranks, to which every rank adds what its charges make there. They are few, so that all ranks may see
/// all of them.
class ContactPoints {
public:
    /// Collective.
    /// @param points   of this rank [m]
    /// @param leftOut  tag of the particle that does not act on each
    ContactPoints(const Points& points, const std::vector<int>& leftOut, MPI_Comm communicator);

    Index size() const { return places_.rows(); }
    Vector3 place(Index point) const { return places_.row(point).matrix().transpose(); }
    int leftOut(Index point) const { return tags_[static_cast<std::size_t>(point)]; }
    void add(Index point, const Vector3& field) { sums_.row(point) += field.transpose().array(); }
    /// Sums over ranks at this rank's points. Collective.
    void sum(Points& field);

private:
    MPI_Comm communicator_;
    Index first_ = 0, own_;
    Points places_, sums_;
    std::vector<int> tags_;
};

}  // namespace him
