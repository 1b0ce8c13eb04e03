// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/cell_mesh.hpp"

namespace him {

/// What the exchange with particles needs of the gas's mesh. SI units. Cell indices are local to the rank.
class GasMesh : public CellMesh {
public:
    virtual double cellVolume(Index cell) const = 0;  ///< [m3]
    /// Spreads values per volume by diffusion over a length [m]: solves (1 - L^2/4 laplacian) f = f_0 with nothing crossing the
    /// boundary, which keeps the volume integral. Its own adjoint under that integral. Collective.
    virtual void smooth(Scalars& perVolume, double length) const = 0;
};

}  // namespace him
