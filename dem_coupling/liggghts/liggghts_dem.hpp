// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_drag.hpp"
#include "dem_coupling/liggghts/fix_couple_cfd_efield.hpp"
#include "dem_coupling/liggghts/liggghts_screen.hpp"
#include "dem_coupling/point_field.hpp"

#include "lammps.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixPropertyAtom;
}

namespace him {

/// The DEM side on LIGGGHTS as a library in this process.
class LiggghtsDem : public DemPort, public PointFieldUser {
public:
    LiggghtsDem(const DemOptions& options, MPI_Comm communicator);

    double timeStep() const override;
    Box box() const override;
    std::array<bool, 3> periodic() const override;
    const std::vector<DemWall>& walls() const override { return walls_; }
    int particleTypes() const override;
    std::string planeOfMotion() const override;
    bool charging() const override { return charging_ != nullptr; }
    std::string chargingDescription() const override;
    Complaints check() const override;
    std::vector<Vector3> wallPoints(std::size_t wall) const override;
    bool ranBeforeHandOver() const override;

    void setWallRoles(const std::vector<WallRole>& roles) override;
    void setWallContactField(WallContactField field) override;
    void setPermittivity(double permittivity) override;
    void setPartnerCutoff(double cutoff) override;
    void setNearField(NearFieldRefresh& near, long interval) override;
    bool usesPointField() const override { return charging_ && charging_->atContactPoint(); }
    void setPointField(PointField& field) override { pointField_ = &field; }
    void allowRemovals(bool allowed) override { removalsAllowed_ = allowed; }
    void chargeParticles() override;
    void handOver() override;

    void particles(DemParticles& out) const override;
    void setField(const DemParticles& particles, const Points& field, const Points& ownResponse) override;
    void run(long steps) override;
    void setGasForces(const GasForces& forces, double duration) override;
    bool gasForcesRestarted() const override;
    Vector3 gasImpulse(Points& beyond) const override;
    std::int64_t particleCount() const override { return expected_; }

    ChargeMovements movements() const override;
    ContactCounts contacts() const override;
    void takeWallCharges(std::vector<WallCharge>& out) override;
    void writeCheckpoint(const std::string& file) override;

    void stopCharging() override;
    bool losesCharge() const override;
    void setCharges(const Scalars& charge) override;
    void giveToWalls(const std::vector<double>& charge) override;
    void keepNotes(int columns) override;
    void notes(Notes& out) const override;
    void setNotes(const Notes& notes) override;

    double largestRadius() const override;
    Vector3 gravity() const override;
    double chargingAcceleration() const override;
    std::vector<WallEquilibrium> equilibria() const override;
    std::vector<std::string> keepWallForces() override;
    void wallForces(std::vector<Points>& out) const override;

private:
    /// What the books need to tell how much charge left with particles that the script took out.
    struct Account {
        std::int64_t arrivals = 0;  ///< particles that appeared since the hand-over, this rank
        double charge = 0;          ///< this rank [C]
        double moved = 0;           ///< inserted less given to walls, all ranks [C]
    };
    Account account() const;
    void countParticles(const Account& before);

    void command(const std::string& line);
    /// The fix that holds the field: the script's, which may have a limiter, or one that is made now.
    void makeFieldFix();
    void checkContactModels(Complaints& complaints) const;

    std::string script_;
    MPI_Comm communicator_;
    std::unique_ptr<LiggghtsScreen> screen_;  ///< outlives lmp_, which writes to it
    std::unique_ptr<LAMMPS_NS::LAMMPS> lmp_;
    std::vector<DemWall> walls_;
    FixChargeGranContact* charging_ = nullptr;
    FixCoupleCfdEfield* field_ = nullptr;  ///< made with the first field, or before the gas's fix
    FixCoupleCfdDrag* drag_ = nullptr;     ///< null without a gas
    bool needsCharge_;
    std::vector<LAMMPS_NS::FixPropertyAtom*> wallForces_;  ///< per wall fix; empty unless asked for
    LAMMPS_NS::FixPropertyAtom* notes_ = nullptr;          ///< null unless asked for
    int noteColumns_ = 0;
    PointField* pointField_ = nullptr;
    NearFieldRefresh* near_ = nullptr;  ///< until the field fix is there, which takes it
    long nearInterval_ = 0;
    bool setUpNext_ = false;  ///< the next run() computes the forces of its first step anew
    bool removalsAllowed_ = false;
    std::int64_t expected_ = 0;
    double removed_ = 0;  ///< charge of particles taken out since the hand-over, all ranks [C]
};

}  // namespace him
