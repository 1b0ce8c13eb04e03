// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/fix_constrain_plane.hpp"

#include "dem_coupling/liggghts/find_fix.hpp"

#include "atom.h"
#include "domain.h"
#include "error.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

/// A particle may be off the plane by this share of its radius; it is then moved onto it.
constexpr double offPlaneTolerance = 1e-6;

std::string shown(const Vector3& vector)
{
    std::ostringstream text;
    text << '(' << vector[0] << ' ' << vector[1] << ' ' << vector[2] << ')';
    return text.str();
}

Vector3 readVector(const std::vector<std::string>& words, std::size_t first, const std::string& keyword)
{
    Vector3 vector;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (first + axis >= words.size()) {
            throw std::invalid_argument("'" + keyword + "' needs three numbers");
        }
        const std::string& text = words[first + axis];
        char* end = nullptr;
        vector[static_cast<Index>(axis)] = std::strtod(text.c_str(), &end);
        if (*end != '\0' || !std::isfinite(vector[static_cast<Index>(axis)])) {
            throw std::invalid_argument("'" + keyword + "' needs three finite numbers, found '" + text + "'");
        }
    }
    return vector;
}

}  // namespace

FixConstrainPlane::FixConstrainPlane(LAMMPS_NS::LAMMPS* liggghts, int narg, char** arg) : Fix(liggghts, narg, arg)
{
    if (domain->dimension == 2) {
        error->fix_error(FLERR, this,
                         "found 'dimension 2', which makes discs of unit length with another mass and other contacts than "
                         "spheres. Remove it: this fix confines spheres to a plane in 'dimension 3'");
    }
    if (!atom->radius_flag || !atom->omega_flag || !atom->torque_flag) {
        error->fix_error(FLERR, this, "needs spheres: write 'atom_style hybrid granular charge'");
    }
    try {
        readWords(std::vector<std::string>(arg + 3, arg + narg));
    } catch (const std::invalid_argument& wrong) {
        error->fix_error(FLERR, this, wrong.what());
    }
}

void FixConstrainPlane::readWords(const std::vector<std::string>& words)
{
    bool haveNormal = false;
    for (std::size_t next = 0; next < words.size(); next += 4) {
        const std::string& keyword = words[next];
        if (keyword == "normal") {
            const Vector3 normal = readVector(words, next + 1, keyword);
            if (!(normal.norm() > 0)) {
                throw std::invalid_argument("'normal' is (0 0 0); give the direction that the particles may not move in");
            }
            normal_ = normal.normalized();
            haveNormal = true;
        } else if (keyword == "point") {
            point_ = readVector(words, next + 1, keyword);
        } else {
            throw std::invalid_argument("unknown keyword '" + keyword + "'; known: normal, point");
        }
    }
    if (!haveNormal) {
        throw std::invalid_argument("'normal nx ny nz' is missing");
    }
}

const FixConstrainPlane* FixConstrainPlane::find(LAMMPS_NS::LAMMPS* lmp)
{
    return findFix<FixConstrainPlane>(lmp);
}

std::string FixConstrainPlane::description() const
{
    return shown(normal_) + " through " + shown(point_) + " m";
}

int FixConstrainPlane::setmask()
{
    return LAMMPS_NS::FixConst::POST_INTEGRATE | LAMMPS_NS::FixConst::PRE_FINAL_INTEGRATE;
}

void FixConstrainPlane::init()
{
    projectMotion();
}

void FixConstrainPlane::post_integrate()
{
    projectMotion();
}

void FixConstrainPlane::projectMotion()
{
    for (int i = 0; i < atom->nlocal; ++i) {
        if (!(atom->mask[i] & groupbit)) {
            continue;
        }
        Eigen::Map<Vector3> x(atom->x[i]);
        Eigen::Map<Vector3> v(atom->v[i]);
        Eigen::Map<Vector3> omega(atom->omega[i]);
        const double distance = (x - point_).dot(normal_);
        if (std::fabs(distance) > offPlaneTolerance * atom->radius[i]) {
            refuseOffPlane(i, distance);
        }
        x -= distance * normal_;
        v -= v.dot(normal_) * normal_;
        omega = omega.dot(normal_) * normal_;
    }
}

void FixConstrainPlane::pre_final_integrate()
{
    for (int i = 0; i < atom->nlocal; ++i) {
        if (atom->mask[i] & groupbit) {
            Eigen::Map<Vector3> f(atom->f[i]);
            Eigen::Map<Vector3> torque(atom->torque[i]);
            f -= f.dot(normal_) * normal_;
            torque = torque.dot(normal_) * normal_;
        }
    }
}

void FixConstrainPlane::refuseOffPlane(int row, double distance)
{
    std::ostringstream text;
    text << "fix " << id << " constrain/plane: particle " << atom->tag[row] << " at " << shown(Vector3(atom->x[row])) << " m is "
         << std::fabs(distance) << " m off the plane with normal " << description()
         << ". Create and insert particles in the plane, or leave them out of the group of this fix";
    error->one(FLERR, text.str().c_str());
}

}  // namespace him
