// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/projective_charging.hpp"
#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/wall_charge_port.hpp"

#include <mpi.h>
#include <string>
#include <vector>

namespace him {

struct ProjectiveSettings {
    bool active = false;
    long burst = 1;  ///< field updates of true charging
    long leap = 1;   ///< bursts that follow at once
};

/// What happened at the end of one burst. Equal on all ranks.
struct ProjectionRecord {
    double time = 0;                          ///< simulated [s]
    double beyond = 0;                        ///< charging time beyond the simulated one, this leap included [s]
    double gain = 0;                          ///< of all particles in the burst [C]
    double expected = 0;                      ///< what the leap before it had expected of the burst [C]
    double assumed = 0;                       ///< what this leap expects of the next one [C]
    double error = 0;                         ///< projectionError() of the two; 0 for the first burst of all
    double correlation = 0;                   ///< of what successive bursts give a particle beyond the fit
    double leapGain = 0;                      ///< of all particles in the leap [C]
    double givenToWalls = 0;                  ///< in the leap [C]
    std::int64_t stopped = 0;                 ///< particles that stopped at the limit
    std::vector<ChargeProjection::Fit> fits;  ///< by particle type, from 1
};

/// Projective charging of a run: bursts of `burst` field updates, each followed by a leap, see ChargeProjection. What particles
/// gain in a leap, walls lose: every wall, and every face of an insulating one, goes on as in the burst, and the rest of the
/// sum is shared among them by how much they took part in it.
class ProjectiveRun {
public:
    /// Makes the DEM keep numbers with the particles, so before the hand-over. Collective.
    /// @param faces  insulating walls, may be null; outlives this
    ProjectiveRun(const ProjectiveSettings& settings, DemPort& dem, WallChargePort* faces, MPI_Comm communicator);

    /// Begins the first burst. After the hand-over. Collective.
    void start(double time);
    /// Call after every field update, between reading the particles and their field. At the end of a burst changes the charges, here
    /// and in the DEM, and returns true. Collective.
    bool update(DemParticles& particles, double time);

    const ProjectionRecord& record() const { return record_; }
    long leaps() const { return leaps_; }
    double meanError() const { return errors_ > 0 ? sumOfErrors_ / static_cast<double>(errors_) : 0; }
    double largestError() const { return largestError_; }
    bool insideBurst() const { return updates_ > 0; }

    /// What a run that continues must know beside the checkpoint of the DEM; one line of numbers.
    std::string state() const;
    /// Takes up such a state before start(); of bursts of another length the charging time and the counts only. Returns false, and
    /// begins anew, when the text is none.
    bool restore(const std::string& state);

private:
    void beginBurst(const DemParticles& particles, const Scalars& rest, double time);
    Scalars sharesOf(const DemParticles& particles) const;
    double correlate(const Notes& notes, const Scalars& rest, const std::vector<Index>& rows);
    double settleWalls(double gained, double burstGain);

    ProjectiveSettings settings_;
    DemPort& dem_;
    WallChargePort* faces_;
    MPI_Comm communicator_;
    std::vector<double> wallMarks_;      ///< DemPort::movements().toWall at the start of the burst [C]
    double burstStart_ = 0;              ///< [s]
    long updates_ = 0;                   ///< of the burst
    double together_ = 0, squares_ = 0;  ///< sums of products of rests, older ones weigh less [C2]
    bool sameBursts_ = true;  ///< what the state of an earlier run says of its last burst holds for this run's
    bool expects_ = false;    ///< a leap has been made before
    long leaps_ = 0, errors_ = 0;
    double sumOfErrors_ = 0, largestError_ = 0;
    ProjectionRecord record_;
    std::vector<double> burstGains_;  ///< of each wall [C]
};

}  // namespace him
