// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/local_mesh.hpp"

#include <cmath>

namespace him {

double cellSize(const LocalMesh& mesh, Index cell)
{
    return std::cbrt(mesh.volume[cell]);
}

}  // namespace him
