// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "lammps.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair.h"
#include "update.h"

#include "contact_models.h"
#include "fix_wall_gran_base.h"
#include "granular_pair_style.h"
#include "granular_wall.h"
#include "pair_gran_base.h"

#include <cstdint>

namespace him {

namespace models = LIGGGHTS::ContactModels;

/// Registers one combination of contact models for pairs and for walls.
template <int normal, int tangential, int cohesion, int rolling> void registerCombination()
{
    using Style = models::GranStyle<normal, tangential, cohesion, rolling, models::SURFACE_DEFAULT>;
    using Model = models::ContactModel<Style>;
    using PairStyle = LIGGGHTS::PairStyles::Granular<Model>;
    using WallStyle = LIGGGHTS::Walls::Granular<Model>;

    LIGGGHTS::PairStyles::Factory::instance().addStyle(
        "gran", Style::HASHCODE,
        +[](LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::PairGran* parent, std::int64_t hash)
            -> LIGGGHTS::PairStyles::IGranularPairStyle* { return new PairStyle(lmp, parent, hash); });
    LIGGGHTS::Walls::Factory::instance().addStyle(
        "gran", Style::HASHCODE,
        +[](LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::FixWallGran* parent,
            std::int64_t hash) -> LIGGGHTS::Walls::IGranularWall* { return new WallStyle(lmp, parent, hash); });
}

/// All tangential and rolling models with one normal and one cohesion model.
template <int normal, int cohesion> void registerCombinations()
{
    registerCombination<normal, models::TANGENTIAL_HISTORY, cohesion, models::ROLLING_OFF>();
    registerCombination<normal, models::TANGENTIAL_HISTORY, cohesion, models::ROLLING_CDT>();
    registerCombination<normal, models::TANGENTIAL_HISTORY, cohesion, models::ROLLING_EPSD2>();
    registerCombination<normal, models::TANGENTIAL_NO_HISTORY, cohesion, models::ROLLING_OFF>();
    registerCombination<normal, models::TANGENTIAL_NO_HISTORY, cohesion, models::ROLLING_CDT>();
    registerCombination<normal, models::TANGENTIAL_NO_HISTORY, cohesion, models::ROLLING_EPSD2>();
}

// One translation unit each, so that the build can compile them side by side.
void registerHertzCharge();
void registerHertzChargeSjkr();
void registerHookeCharge();
void registerHookeChargeSjkr();

}  // namespace him
