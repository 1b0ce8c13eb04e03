// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/held_field.hpp"
#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/liggghts/force_limiter.hpp"
#include "dem_coupling/point_field.hpp"

#include "fix.h"

#include <cstdint>

namespace him {

/// fix ID group couple/cfd/efield [limit_field_force yes|no] [field_force_limit_factor F]
///
/// Holds the electric field that the host computed at every particle, with the position and charge that made it, and adds
/// F = q E (S2.16) with the particle's charge of the moment. The host sets the field; it stays until the next one.
class FixCoupleCfdEfield : public LAMMPS_NS::Fix {
public:
    FixCoupleCfdEfield(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
    ~FixCoupleCfdEfield() override;

    /// The fix of this LIGGGHTS instance that holds the field, of this style or one derived from it, or null.
    static FixCoupleCfdEfield* find(LAMMPS_NS::LAMMPS* lmp);

    /// Field [V/m] at the owned particles, in the order of their rows. Collective: ghosts get it too, before the first set-up
    /// when they are made.
    /// @param ownResponse  share of it that the particle's own images make, or no rows
    void setField(const Points& field, const Points& ownResponse);
    /// See DemPort::setNearField. Before the first setField().
    void setNearField(NearFieldRefresh& near, long interval);
    /// Who knows the field at contact points with walls.
    void setPointField(PointField* field) { pointField_ = field; }
    bool knowsPoints() const { return pointField_ != nullptr; }
    /// See PointField::fieldOfOthers(), of the positions and charges that made the held field. Collective; throws
    /// std::logic_error where nobody knows it.
    void fieldOfOthers(const Points& points, const std::vector<int>& leftOut, Points& field);
    /// Without rows on a rank that has never had a particle.
    HeldField held() const { return {held_ ? held_[0] : nullptr}; }
    /// Particles that appeared on this rank since this fix was made.
    std::int64_t arrivals() const { return arrivals_; }

    /// Particles and steps whose force was limited. Collective.
    double compute_limited() const;

    int setmask() override;
    void post_run() override;
    double compute_vector(int) override { return compute_limited(); }
    void setup(int) override;
    void post_force(int) override;
    void grow_arrays(int rows) override;
    void copy_arrays(int from, int to, int deleting) override;
    void set_arrays(int row) override;
    int pack_exchange(int row, double* buffer) override;
    int unpack_exchange(int row, double* buffer) override;
    int pack_border(int n, int* list, double* buffer) override;
    int unpack_border(int n, int first, double* buffer) override;
    int pack_comm(int n, int* list, double* buffer, int pbcFlag, int* pbc) override;
    void unpack_comm(int n, int first, double* buffer) override;

protected:
    double** held_ = nullptr;  ///< see HeldField
    bool ghostsExist_ = false;
    ForceLimiter limiter_;

private:
    void addForces();
    /// Puts the short-range field of now in the place of the held one.
    void refreshNearField();

    std::int64_t arrivals_ = 0;
    PointField* pointField_ = nullptr;
    DemParticles sources_;
    // With setNearField(): the held field and own response less their short-range parts at the last update, per row [V/m].
    static constexpr int farWidth = 6;
    double** far_ = nullptr;
    NearFieldRefresh* near_ = nullptr;
    long nearInterval_ = 0;
    long stepsSinceNear_ = 0;
    DemParticles nearParticles_;
    Points nearPart_, nearOwn_;
};

}  // namespace him
