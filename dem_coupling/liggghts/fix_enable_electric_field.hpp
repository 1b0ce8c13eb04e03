// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/liggghts/force_limiter.hpp"

#include "fix.h"

#include <string>
#include <vector>

namespace him {

/// What a line of enable_electric_field says, by the names of its manual page.
struct EnableElectricFieldOptions {
    double cutoff = 0;              ///< field_cutoff_radius [m]
    std::string name;               ///< id; empty: that of the fix
    std::string group;              ///< particle_group; empty: that of the fix
    bool withoutCoupling = true;    ///< use_without_cfd_coupling
    bool charging = false;          ///< enable_collision_charge_transfer
    double separation = 500e-9;     ///< charge_transfer_cutoff [m]
    ForceLimiter limiter;
};

/// Throws std::invalid_argument with everything that is wrong.
EnableElectricFieldOptions readEnableElectricFieldOptions(const std::vector<std::string>& words);

/// fix ID group enable_electric_field keyword value ...
///
/// A script of that command carries on here: makes fix efield/him (liggghtsHim) or takes part in himFoam's field, and fix
/// charge/gran/contact, by the page's own keywords. See doc/enable_electric_field.md.
class FixEnableElectricField : public LAMMPS_NS::Fix {
public:
    FixEnableElectricField(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);

    /// The fix of this LIGGGHTS instance, or null.
    static FixEnableElectricField* find(LAMMPS_NS::LAMMPS* lmp);
    double cutoff() const { return options_.cutoff; }
    std::string description() const;

    int setmask() override { return 0; }
    void post_create() override;  ///< makes the other fixes
    void init() override;         ///< primitive walls take no charge, as the page says
    void pre_delete(bool unfix) override;

private:
    void makeCharging();
    void makeField();
    void add(const std::vector<std::string>& words);

    EnableElectricFieldOptions options_;
    std::string name_;
    std::string group_;
    std::vector<std::string> made_;  ///< ids of the fixes that this one made
};

}  // namespace him
