// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include <functional>

namespace him {

/// A DEM for tests: particles held in memory in free flight, F = q E under the held field, no contacts. Public members are
/// the screws a test turns.
class FakeDem : public DemPort {
public:
    /// @param mine  this rank's particles
    FakeDem(DemParticles mine, const Box& box, const std::array<bool, 3>& periodic, double timeStep,
            MPI_Comm communicator);

    double timeStep() const override { return timeStep_; }
    Box box() const override { return box_; }
    std::array<bool, 3> periodic() const override { return periodic_; }
    const std::vector<DemWall>& walls() const override { return wallList; }
    int particleTypes() const override { return 2; }
    bool charging() const override { return false; }
    std::string chargingDescription() const override { return "no charging\n"; }
    Complaints check() const override { return {}; }
    bool ranBeforeHandOver() const override { return false; }
    void setWallRoles(const std::vector<WallRole>&) override {}
    void setWallContactField(WallContactField) override {}
    void setPermittivity(double) override {}
    void setPartnerCutoff(double cutoff) override { partnerCutoff = cutoff; }
    void allowRemovals(bool) override {}
    void handOver() override { handedOver = true; }
    void particles(DemParticles& out) const override { out = mine; }
    void setField(const DemParticles& particles, const Points& field, const Points& ownResponse) override;
    void run(long steps) override;
    void setGasForces(const GasForces& forces, double duration) override;
    Vector3 gasImpulse(Points& beyond) const override;
    std::int64_t particleCount() const override { return believedCount; }
    ChargeMovements movements() const override { return moved; }
    ContactCounts contacts() const override { return {}; }
    void writeCheckpoint(const std::string&) override {}

    DemParticles mine;
    std::int64_t believedCount = 0;
    ChargeMovements moved;
    std::vector<DemWall> wallList;
    std::function<void()> duringRun;  ///< called at the end of run(), on every rank
    double partnerCutoff = -1;
    bool handedOver = false;
    int fieldsSet = 0;
    Points heldField;                       ///< [V/m]
    GasForces gas;                          ///< empty until setGasForces()
    Points gasGiven, gasPromised;           ///< [N s]
    Vector3 gasTakenOut = Vector3::Zero();  ///< until setGasForces() [N s]

private:
    Box box_;
    std::array<bool, 3> periodic_;
    double timeStep_;
};

}  // namespace him
