// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charge_losses.hpp"
#include "dem_coupling/charging/charge_transfer.hpp"
#include "dem_coupling/charging/contact_recorder.hpp"
#include "dem_coupling/charging/initial_charge.hpp"
#include "dem_coupling/charging/wall_charge_list.hpp"
#include "dem_coupling/charging/wall_contact_memory.hpp"
#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/liggghts/wall_list.hpp"

#include "atom.h"
#include "fix.h"

#include <map>
#include <string>
#include <vector>

namespace him {

class FixCoupleCfdEfield;

/// fix ID group charge/gran/contact pair I J gamma V kappa K ... keyword value ...
///
/// Contact charging: works off the contacts that the contact model `charge` recorded, once per step, after all forces.
/// Also keeps the books: charge given to every wall, and charge of particles that appeared. See doc/charge_gran_contact.md.
class FixChargeGranContact : public LAMMPS_NS::Fix {
public:
    FixChargeGranContact(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
    ~FixChargeGranContact() override;

    /// The charging fix of this LIGGGHTS instance, or null.
    static FixChargeGranContact* find(LAMMPS_NS::LAMMPS* lmp);
    /// A host that hands charging over later sets this before the script is read; fixes then start switched off.
    static bool hosted;

    // --- for the contact model
    ContactRecorder& recorder() { return recorder_; }
    bool contains(int row) const { return atom->mask[row] & groupbit; }
    int wallRow(const LAMMPS_NS::Fix* wall) const;
    /// Reads the list of walls again; keeps the charges given to walls that are still there.
    void refreshWalls();

    /// Finds where the pair style keeps the charge moved within each contact, when it does. During the pair style's set-up.
    void placeHistory();

    // --- for the host
    ChargeTransfer& transfer() { return transfer_; }
    const std::vector<ListedWall>& walls() const { return walls_; }
    void setWallRoles(const std::vector<WallRole>& roles);
    /// Whether contacts with this wall move charge, as far as script and case say.
    bool transfersAt(const std::string& wall) const;
    /// From the hand-over on contacts move no charge and particles lose none; arrivals are still booked.
    void stopCharging() { stopped_ = true; }
    bool losesCharge() const { return losses_.active(); }
    /// Whether the script wants E_other of wall contacts at the contact point.
    bool atContactPoint() const { return transfer_.atContactPoint(); }
    /// Switches charging on and opens the books: the charge that is there now has not been inserted.
    void handOver();
    std::string description();
    /// Pairs of types that can touch and have neither Gamma nor `none`. Collective.
    /// @param where   stands in front of each complaint
    /// @param absent  count types too that neither a particle nor a wall has yet: they may be inserted
    void complainAboutMissingPairs(const std::string& where, bool absent, Complaints& complaints) const;
    /// Gives particles that the script made their initial charge, before the first field is computed from it.
    void prepare();
    /// Sums over ranks. Collective.
    ChargeMovements movements() const;
    ContactCounts contacts() const;
    /// See DemPort::takeWallCharges.
    void takeWallCharges(std::vector<WallCharge>& out);

    // --- LIGGGHTS' life cycle
    int setmask() override;
    void init() override;
    void pre_exchange() override { wallCharges_.separate(); }
    void end_of_step() override;
    /// One more value per pair contact under `update frozen`: the charge it has moved towards the lower tag. Contacts of others
    /// do without, since history is read and written in every step, unless an earlier charging fix made room for it: LIGGGHTS
    /// stops at the next `run` when contacts have more room than is asked for.
    int n_history_extra() override;
    bool history_args(char** args) override;
    void post_run() override;
    /// [0] inserted, [1 + w] given to wall w, then leaked and lost to breakdown [C], times that breakdown acted, contacts
    /// whose x passed 0.5 under `update frozen`.
    double compute_vector(int n) override;
    void grow_arrays(int rows) override;
    void copy_arrays(int from, int to, int deleting) override;
    void set_arrays(int row) override;
    int pack_exchange(int row, double* buffer) override;
    int unpack_exchange(int row, double* buffer) override;
    int pack_comm(int n, int* list, double* buffer, int pbcFlag, int* pbc) override;
    void unpack_comm(int n, int first, double* buffer) override;
    int pack_restart(int row, double* buffer) override;
    void unpack_restart(int row, int nth) override;
    int size_restart(int row) override;
    int maxsize_restart() override;
    void write_restart(FILE* file) override;
    void restart(char* buffer) override;

private:
    /// a_corr of every pair from the real moduli and those of the script (S2.12).
    void findSoftening();
    /// What to say when the time step is too long for the contact area to be sampled; empty when it is not. Collective.
    std::string timeStepWarning() const;
    /// Charge of particles that are seen for the first time and bring none (initialCharge).
    void chargeNewParticles();
    /// What the contacts of a step move, by transfer_.
    void moveCharges();
    void loseCharge();
    void tell(const std::string& text) const;
    /// Refuses pairs without Gamma, and warns of those of types that are not there yet.
    void checkPairs();
    /// A number for a wall's name in restart files.
    static double markOf(const std::string& wall);
    /// Says what a restart file knows of walls that are not there any more.
    void tellOfLostWalls();
    std::size_t packRow(int row, double* buffer) const;
    void bookArrivals();
    /// E_other of the growing wall contacts at their contact points. Collective.
    void findFieldAtContactPoints();

    ContactRecorder recorder_;
    ChargeTransfer transfer_;
    WallContactMemory wallMemory_;
    std::vector<GrowingWallContact> growingWallContacts_;
    std::vector<ListedWall> walls_;
    std::vector<WallRole> roles_;
    WallChargeList wallCharges_;  ///< not taken yet
    std::vector<char> booked_;    ///< per row: the particle's charge stands in the books
    std::vector<char> charged_;   ///< per row: the particle got its initial charge, or brought one
    bool arrivals_ = false;       ///< some row is not booked yet
    bool enabled_;
    bool stopped_ = false;        ///< the host holds the charges
    bool roomInHistory_ = false;  ///< contacts have room for a value of ours from before this fix
    FixCoupleCfdEfield* field_ = nullptr;
    CompensatedSum inserted_;
    std::map<double, double>
        restartedToWall_;  ///< charge [C] by markOf() a wall, from a restart file, until the wall is defined
    double pairsBegun_ = 0;
    double wallContactsBegun_ = 0;
    double curvature_ = 0;
    ChargeLosses losses_;
    InitialCharges initial_;
    std::map<int, double> realModuli_;
    bool told_ = false;  ///< the description stands in the log
    Points contactPoints_, fieldAtPoints_;
    std::vector<int> contactTags_;
};

}  // namespace him
