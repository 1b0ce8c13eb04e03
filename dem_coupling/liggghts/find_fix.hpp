// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lammps.h"
#include "modify.h"

namespace him {

/// The first fix of a class in this LIGGGHTS instance, or null. While LIGGGHTS replaces a fix by another with the same ID, its list has
/// a gap where the old one was; Modify::find_fix_style() follows that null pointer.
template <typename Wanted> Wanted* findFix(LAMMPS_NS::LAMMPS* lmp)
{
    for (int i = 0; i < lmp->modify->nfix; ++i) {
        if (auto* fix = dynamic_cast<Wanted*>(lmp->modify->fix[i])) {
            return fix;
        }
    }
    return nullptr;
}

}  // namespace him
