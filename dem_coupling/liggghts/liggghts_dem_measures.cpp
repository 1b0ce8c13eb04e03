// SPDX-License-Identifier: GPL-3.0-or-later
// What LiggghtsDem measures on request: gravity, equilibrium charges, forces of walls.
#include "dem_coupling/liggghts/liggghts_dem.hpp"

#include "dem_coupling/liggghts/private_access.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/parameters/equilibrium_charge.hpp"

#include "atom.h"
#include "fix_gravity.h"
#include "fix_particledistribution_discrete.h"
#include "fix_property_atom.h"
#include "fix_wall_gran.h"
#include "modify.h"

#include <algorithm>

namespace him {

struct StoresWallForce {
    using Member = bool LAMMPS_NS::FixWallGran::*;
    friend Member memberOf(StoresWallForce);
};
template struct PrivateMember<StoresWallForce, &LAMMPS_NS::FixWallGran::store_force_>;

struct WallForceStorage {
    using Member = LAMMPS_NS::FixPropertyAtom* LAMMPS_NS::FixWallGran::*;
    friend Member memberOf(WallForceStorage);
};
template struct PrivateMember<WallForceStorage, &LAMMPS_NS::FixWallGran::fix_wallforce_>;

double LiggghtsDem::largestRadius() const
{
    double largest = 0;
    for (int i = 0; i < lmp_->atom->nlocal; ++i) {
        largest = std::max(largest, lmp_->atom->radius[i]);
    }
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    LAMMPS_NS::Modify& modify = *lmp_->modify;
    for (int n = 0; n < modify.nfix; ++n) {
        if (auto* sizes = dynamic_cast<LAMMPS_NS::FixParticledistributionDiscrete*>(modify.fix[n])) {
            largest = std::max(largest, sizes->max_rad());
        }
    }
    return largest;
}

Vector3 LiggghtsDem::gravity() const
{
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < lmp_->modify->nfix; ++i) {
        if (auto* fix = dynamic_cast<LAMMPS_NS::FixGravity*>(lmp_->modify->fix[i])) {
            fix->init();  // the direction is not set before
            Vector3 one;
            fix->get_gravity(one.data());
            sum += one;
        }
    }
    return sum;
}

double LiggghtsDem::chargingAcceleration() const
{
    return charging_ ? charging_->transfer().pairs().acceleration() : 1;
}

int LiggghtsDem::particleTypes() const
{
    return lmp_->atom->ntypes;
}

std::vector<WallEquilibrium> LiggghtsDem::equilibria() const
{
    std::vector<WallEquilibrium> found;
    if (!charging_) {
        return found;
    }
    const ChargeTransfer& transfer = charging_->transfer();
    const LAMMPS_NS::Atom& atom = *lmp_->atom;
    const auto types = static_cast<std::size_t>(atom.ntypes) + 1;
    std::vector<double> sums(4 * types, 0.0);  // number, diameter, mass, volume of each type
    for (int i = 0; i < atom.nlocal; ++i) {
        double* of = &sums[4 * static_cast<std::size_t>(atom.type[i])];
        const double d = 2 * atom.radius[i];
        of[0] += 1;
        of[1] += d;
        of[2] += atom.rmass[i];
        of[3] += pi / 6 * d * d * d;
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    const double strength = gravity().norm();
    for (int type = 1; type <= atom.ntypes; ++type) {
        const double* of = &sums[4 * static_cast<std::size_t>(type)];
        if (of[0] == 0) {
            continue;
        }
        for (int material = 1; material <= atom.ntypes; ++material) {
            WallEquilibrium one{type, material, {}, 0, of[1] / of[0], 0, 0};
            for (const ListedWall& listed : charging_->walls()) {
                if (listed.wall.type == material && listed.wall.chargingModel
                    && charging_->transfersAt(listed.wall.name)) {
                    one.walls.push_back(listed.wall.name);
                }
            }
            const ChargingPair& pair = transfer.pairs().of(type, material);
            if (one.walls.empty() || !pair.transfers) {
                continue;
            }
            one.transferLimit = pair.limit(0.5 * one.diameter, 0);
            one.charge = equilibriumCharge(one.transferLimit, one.diameter, transfer.permittivity())
                         / (transfer.ownImage() ? 2 : 1);
            if (strength > 0) {
                const double mass = of[2] / of[3] * pi / 6 * one.diameter * one.diameter * one.diameter;
                one.forceOverWeight =
                    forceOverWeight(one.charge, one.diameter, transfer.permittivity(), mass, strength);
            }
            found.push_back(one);
        }
    }
    return found;
}

std::vector<std::string> LiggghtsDem::keepWallForces()
{
    std::vector<std::string> names;
    wallForces_.clear();
    for (int i = 0; i < lmp_->modify->nfix; ++i) {
        auto* wall = dynamic_cast<LAMMPS_NS::FixWallGran*>(lmp_->modify->fix[i]);
        if (!wall) {
            continue;
        }
        names.emplace_back(wall->id);
        LAMMPS_NS::FixPropertyAtom*& storage = wall->*memberOf(WallForceStorage{});
        if (!storage) {  // the script did not write store_force yes
            const std::string id = "himFoamWallForce_" + names.back();
            command("fix " + id + " all property/atom " + id + " vector no no no 0. 0. 0.");
            storage = static_cast<LAMMPS_NS::FixPropertyAtom*>(lmp_->modify->find_fix_id(id.c_str()));
            wall->*memberOf(StoresWallForce{}) = true;
        }
        wallForces_.push_back(storage);
    }
    return names;
}

void LiggghtsDem::wallForces(std::vector<Points>& out) const
{
    const int rows = lmp_->atom->nlocal;
    out.resize(wallForces_.size());
    for (std::size_t wall = 0; wall < out.size(); ++wall) {
        out[wall].resize(rows, 3);
        for (int i = 0; i < rows; ++i) {
            for (int d = 0; d < 3; ++d) {
                out[wall](i, d) = wallForces_[wall]->array_atom[i][d];
            }
        }
    }
}

}  // namespace him
