// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include <mpi.h>

namespace him {

/// What replaceByMean() did. Equal on all ranks.
struct UniformCharge {
    double particles = 0;
    double mean = 0;        ///< [C]
    double before = 0;      ///< total charge [C]
    double after = 0;       ///< total charge [C]
    double absolute = 0;    ///< sum of absolute charges before [C]
    bool replaced = false;  ///< false where all charges were the same already, and nothing was touched
};

/// Gives every particle the mean charge of all of them, whatever its size, as S does before it goes on from saturation with a
/// fixed uniform charge. Charges that are equal already stay bit for bit, so that a run that continues such a run is the same
/// run. Collective; before the first field.
UniformCharge replaceByMean(DemPort& dem, MPI_Comm communicator);

}  // namespace him
