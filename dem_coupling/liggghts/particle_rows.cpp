// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/particle_rows.hpp"

#include "atom.h"

namespace him {

void readRows(const LAMMPS_NS::Atom& atom, DemParticles& out)
{
    const int n = atom.nlocal;
    out.tag.assign(atom.tag, atom.tag + n);
    out.type.assign(atom.type, atom.type + n);
    out.position.resize(n, 3);
    out.velocity.resize(n, 3);
    for (int i = 0; i < n; ++i) {
        for (int d = 0; d < 3; ++d) {
            out.position(i, d) = atom.x[i][d];
            out.velocity(i, d) = atom.v[i][d];
        }
    }
    if (atom.q) {
        out.charge = Eigen::Map<const Scalars>(atom.q, n);
    } else {
        out.charge.setZero(n);
    }
    out.radius = Eigen::Map<const Scalars>(atom.radius, n);
    out.mass = Eigen::Map<const Scalars>(atom.rmass, n);
}

}  // namespace him
