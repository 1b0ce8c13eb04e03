// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/types.hpp"

#include "fix.h"

#include <string>
#include <vector>

namespace him {

/// fix ID group constrain/plane normal nx ny nz [point x y z]
///
/// Spheres confined to a plane: two-dimensional scenes of real spheres. Takes the component along the normal out of
/// positions, velocities and forces, and keeps only that component of angular velocities and torques. Acts after all other
/// fixes of a stage, wherever it stands in the script. See doc/constrain_plane.md.
class FixConstrainPlane : public LAMMPS_NS::Fix {
public:
    FixConstrainPlane(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);

    /// The constraint of this LIGGGHTS instance, or null.
    static const FixConstrainPlane* find(LAMMPS_NS::LAMMPS* lmp);

    /// "(nx ny nz) through (x y z) m"
    std::string description() const;

    int setmask() override;
    void init() override;
    void post_integrate() override;
    void pre_final_integrate() override;

private:
    void readWords(const std::vector<std::string>& words);
    void projectMotion();
    /// Stops the run over a row whose particle is off the plane by `distance` [m].
    void refuseOffPlane(int row, double distance);

    Vector3 normal_;                    ///< unit
    Vector3 point_ = Vector3::Zero();  ///< on the plane [m]
};

}  // namespace him
