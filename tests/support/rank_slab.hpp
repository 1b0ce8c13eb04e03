// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include <mpi.h>

namespace him {

/// The layers [first, last) of a lattice that this rank holds when `layers` of them are cut into slabs of one size.
struct RankSlab {
    Index first = 0;
    Index last = 0;

    RankSlab(Index layers, MPI_Comm communicator)
    {
        int rank = 0;
        int ranks = 1;
        MPI_Comm_rank(communicator, &rank);
        MPI_Comm_size(communicator, &ranks);
        first = layers * rank / ranks;
        last = layers * (rank + 1) / ranks;
    }
};

}  // namespace him
