// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_registry.hpp"

#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"
#include "dem_coupling/liggghts/fix_constrain_plane.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_drag.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"
#include "dem_coupling/liggghts/fix_efield_him.hpp"
#include "dem_coupling/liggghts/fix_enable_electric_field.hpp"
#include "dem_coupling/liggghts/private_access.hpp"

#include "lammps.h"
#include "modify.h"

#include <map>
#include <stdexcept>
#include <string>

namespace him {

using FixCreator = LAMMPS_NS::Fix* (*)(LAMMPS_NS::LAMMPS*, int, char**);

struct FixMap {
    using Member = std::map<std::string, FixCreator>* LAMMPS_NS::Modify::*;
    friend Member memberOf(FixMap);
};
template struct PrivateMember<FixMap, &LAMMPS_NS::Modify::fix_map>;

namespace {

template <typename FixStyle> LAMMPS_NS::Fix* create(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg)
{
    return new FixStyle(lmp, narg, arg);
}

}  // namespace

void registerFixes(LAMMPS_NS::LAMMPS* lmp)
{
    auto& styles = *(lmp->modify->*memberOf(FixMap{}));
    const std::map<std::string, FixCreator> ours{
        {"charge/gran/contact", &create<FixChargeGranContact>},
        {"constrain/plane", &create<FixConstrainPlane>},
        {"couple/cfd/drag", &create<FixCoupleCfdDrag>},
        {"couple/cfd/efield", &create<FixCoupleCfdEfield>},
        {"efield/him", &create<FixEfieldHim>},
        {"enable_electric_field", &create<FixEnableElectricField>},
    };
    for (const auto& [name, creator] : ours) {
        if (!styles.emplace(name, creator).second) {
            throw std::runtime_error("LIGGGHTS already has a fix style '" + name + "'");
        }
    }
}

}  // namespace him
