// SPDX-License-Identifier: GPL-3.0-or-later
// The walls that fix charge/gran/contact charges at, and what each keeps.
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"

#include "atom.h"
#include "error.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <sstream>

namespace him {

int FixChargeGranContact::wallRow(const LAMMPS_NS::Fix* wall) const
{
    for (std::size_t row = 0; row < walls_.size(); ++row) {
        if (walls_[row].fix == wall) {
            return static_cast<int>(row);
        }
    }
    error->one(FLERR, "a wall touches particles that fix charge/gran/contact does not know");
    return -1;
}

double FixChargeGranContact::markOf(const std::string& wall)
{
    // FNV-1a, cut to what a double holds.
    std::uint64_t mark = 14695981039346656037U;
    for (const char c : wall) {
        mark = (mark ^ static_cast<unsigned char>(c)) * 1099511628211U;
    }
    return static_cast<double>(mark >> 12);
}

void FixChargeGranContact::tellOfLostWalls()
{
    double lost = 0;
    for (const auto& [mark, charge] : restartedToWall_) {
        lost += charge;
    }
    if (lost != 0) {
        std::ostringstream text;
        text << "WARNING: the restart file gives " << lost
             << " C to walls that the script does not have any more; the books go on without it.\n";
        tell(text.str());
    }
    restartedToWall_.clear();
}

void FixChargeGranContact::refreshWalls()
{
    std::vector<ListedWall> now = listWalls(lmp);
    std::vector<CompensatedSum> given(now.size());
    std::vector<int> types;
    std::vector<char> transfers, keeps;
    for (std::size_t row = 0; row < now.size(); ++row) {
        const DemWall& wall = now[row].wall;
        types.push_back(wall.type);
        const auto role =
            std::find_if(roles_.begin(), roles_.end(), [&](const WallRole& r) { return r.name == wall.name; });
        transfers.push_back(role == roles_.end() || role->transfersCharge);
        keeps.push_back(role != roles_.end() && role->keepsCharge);
        for (std::size_t old = 0; old < walls_.size(); ++old) {
            if (walls_[old].wall.name == wall.name) {
                given[row] = transfer_.toWall()[old];
            }
        }
    }
    for (std::size_t row = 0; row < now.size(); ++row) {
        const auto earlier = restartedToWall_.find(markOf(now[row].wall.name));
        if (earlier != restartedToWall_.end()) {
            given[row] = CompensatedSum(earlier->second);
            restartedToWall_.erase(earlier);
        }
    }
    walls_ = std::move(now);
    transfer_.setWalls(std::move(types), std::move(transfers), std::move(keeps));
    transfer_.toWall() = std::move(given);
    size_vector = 1 + static_cast<int>(walls_.size()) + 4;
}

void FixChargeGranContact::complainAboutMissingPairs(const std::string& where, bool absent,
                                                     Complaints& complaints) const
{
    std::set<int> wallTypes, particleTypes;
    for (const ListedWall& wall : walls_) {
        if (wall.wall.chargingModel) {
            wallTypes.insert(wall.wall.type);
        }
    }
    std::vector<int> present(static_cast<std::size_t>(atom->ntypes) + 1, 0);
    for (int i = 0; i < atom->nlocal; ++i) {
        present[static_cast<std::size_t>(atom->type[i])] = 1;
    }
    MPI_Allreduce(MPI_IN_PLACE, present.data(), static_cast<int>(present.size()), MPI_INT, MPI_MAX, world);
    for (int type = 1; type <= atom->ntypes; ++type) {
        if (present[static_cast<std::size_t>(type)] || (absent && !wallTypes.count(type))) {
            particleTypes.insert(type);
        }
    }
    transfer_.pairs().complainAboutMissing({particleTypes.begin(), particleTypes.end()},
                                           {wallTypes.begin(), wallTypes.end()}, where, complaints);
}

void FixChargeGranContact::checkPairs()
{
    Complaints missing;
    complainAboutMissingPairs("types", false, missing);
    if (!missing.none()) {
        error->fix_error(FLERR, this, missing.text().c_str());
    }
    complainAboutMissingPairs("types", true, missing);
    if (!missing.none() && !told_) {
        tell("WARNING: no charge will move between these, should such particles be inserted:\n" + missing.text());
    }
}

void FixChargeGranContact::setWallRoles(const std::vector<WallRole>& roles)
{
    // What the script says about a wall stands; the case's word joins it.
    for (const WallRole& role : roles) {
        const auto own =
            std::find_if(roles_.begin(), roles_.end(), [&](const WallRole& r) { return r.name == role.name; });
        if (own == roles_.end()) {
            roles_.push_back(role);
        } else {
            own->transfersCharge = own->transfersCharge && role.transfersCharge;
            own->keepsCharge = own->keepsCharge || role.keepsCharge;
        }
    }
    refreshWalls();
}

bool FixChargeGranContact::transfersAt(const std::string& wall) const
{
    return std::all_of(roles_.begin(), roles_.end(),
                       [&](const WallRole& role) { return role.name != wall || role.transfersCharge; });
}

void FixChargeGranContact::findFieldAtContactPoints()
{
    const auto contacts = static_cast<Index>(growingWallContacts_.size());
    contactPoints_.resize(contacts, 3);
    contactTags_.clear();
    for (Index n = 0; n < contacts; ++n) {
        const GrowingWallContact& contact = growingWallContacts_[static_cast<std::size_t>(n)];
        // Of the position that made the field, as everything else that charging knows of it.
        const double* centre = field_->held().row(contact.particle) + HeldField::position;
        const double radius = atom->radius[contact.particle];
        for (int d = 0; d < 3; ++d) {
            contactPoints_(n, d) = centre[d] + radius * contact.normal[d];
        }
        contactTags_.push_back(atom->tag[contact.particle]);
    }
    field_->fieldOfOthers(contactPoints_, contactTags_, fieldAtPoints_);
    for (Index n = 0; n < contacts; ++n) {
        GrowingWallContact& contact = growingWallContacts_[static_cast<std::size_t>(n)];
        contact.fieldNormal = fieldAtPoints_.row(n).matrix().dot(Eigen::Map<const Eigen::RowVector3d>(contact.normal));
    }
}

void FixChargeGranContact::takeWallCharges(std::vector<WallCharge>& out)
{
    wallCharges_.take(out);
}

}  // namespace him
