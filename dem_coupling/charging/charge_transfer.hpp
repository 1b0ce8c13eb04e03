// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charging_pairs.hpp"
#include "dem_coupling/charging/compensated_sum.hpp"
#include "dem_coupling/charging/contact_recorder.hpp"
#include "dem_coupling/charging/held_field.hpp"
#include "dem_coupling/charging/wall_contact_memory.hpp"
#include "dem_coupling/dem_port.hpp"
#include "electrostatics/contact_charging.hpp"
#include "electrostatics/parameters/charging_efficiency.hpp"

#include <limits>
#include <vector>

namespace him {

/// The DEM's arrays of one step. Rows [0, local) are owned, [local, all) are ghosts.
struct DemRows {
    int local = 0;
    int all = 0;
    const int* tag = nullptr;
    const int* type = nullptr;
    const double* radius = nullptr;  ///< [m]
    double* charge = nullptr;        ///< [C]
    HeldField held;
};

/// Moves the charge of one step's growing contacts: physics.md's law with the factor shared by all contacts of a
/// particle, evaluated in tag order, so that both ranks of a contact get bit-opposite numbers, and applied once.
class ChargeTransfer {
public:
    ChargeTransfer(ChargingPairs pairs, double permittivity) : pairs_(std::move(pairs))
    {
        setPermittivity(permittivity);
    }

    void setPermittivity(double permittivity);
    void setWallContactField(WallContactField field) { wallField_ = field; }
    WallContactField wallContactField() const { return wallField_; }
    /// Whether wall contacts take E_other of GrowingWallContact in place of the held field at the particle's centre.
    void setAtContactPoint(bool atPoint) { atContactPoint_ = atPoint; }
    bool atContactPoint() const { return atContactPoint_; }
    void setUpdate(WithinContact update) { update_ = update; }
    /// Whether the touching wall's image of the particle opposes charging too. It doubles the own field at the contact.
    void setOwnImage(bool included) { ownFieldFactor_ = included ? 2 : 1; }
    void setPartnerCutoff(double cutoff) { partnerCutoff_ = cutoff; }
    /// One entry per wall.
    /// @param keeps  whether wallGains() lists the charges of this wall
    void setWalls(std::vector<int> types, std::vector<char> transfers, std::vector<char> keeps = {});
    /// Shortest vector between two positions in a periodic box, in place; null for an open box.
    void setMinimumImage(void (*shorten)(void* box, double* vector), void* box)
    {
        shorten_ = shorten;
        box_ = box;
    }

    const ChargingPairs& pairs() const { return pairs_; }
    /// After a change of the pairs call setPermittivity() again.
    ChargingPairs& pairs() { return pairs_; }
    double permittivity() const { return permittivity_; }
    WithinContact update() const { return update_; }
    bool ownImage() const { return ownFieldFactor_ == 2; }

    /// First half of a step: sums every particle's relaxation numbers. Afterwards relaxationSums() of the ghosts must be
    /// filled from their owners, like their charges.
    void sumRelaxations(const DemRows& rows, const GrowingPairs& pairs,
                        const std::vector<GrowingWallContact>& wallContacts);
    std::vector<double>& relaxationSums() { return relaxationSums_; }

    /// Second half: computes every contact's charge, then applies all of it to the owned rows. With a held field the pairs
    /// must have kept their normals, with frozen charges what is within the contact.
    void move(const DemRows& rows, const GrowingPairs& pairs, const std::vector<GrowingWallContact>& wallContacts);

    /// Charge given to each wall by this rank [C].
    std::vector<CompensatedSum>& toWall() { return toWall_; }
    const std::vector<CompensatedSum>& toWall() const { return toWall_; }
    double largestRelaxation() const { return largestRelaxation_; }
    /// Contacts whose x passed 0.5 under `frozen`, above which it may overshoot; this rank.
    double& strongFrozenContacts() { return strongFrozen_; }
    double strongFrozenContacts() const { return strongFrozen_; }

    /// What the walls that keep their charge gained in the last move().
    struct WallGain {
        int particle;
        int wall;
        double normal[3];  ///< from the particle into the wall
        double charge;     ///< [C]
    };
    const std::vector<WallGain>& wallGains() const { return wallGains_; }

private:
    double limitOf(const DemRows& rows, const ChargingPair& law, int a, int b) const;
    /// x [-] of a contact of that particle, see relaxationNumber().
    double numberOf(int row, double rate, double growth) const { return rate * growth * inverseSurface_[row]; }
    /// Field [V/m] of a charge at the surface of that particle, see surfaceField().
    double surfaceFieldOf(int row, double charge) const { return charge * inverseSurface_[row] / permittivity_; }
    double gainedBy(double drive, double relaxation, double rate, double growth) const;
    void countFrozen(double xNow, double xBefore);
    double fieldAtContact(const DemRows& rows, int a, int b, const double* normal) const;

    ChargingPairs pairs_;
    double permittivity_ = 0;
    double coulomb_ = 0;  ///< 1/(4 pi eps) [m/F]
    WallContactField wallField_ = WallContactField::total;
    bool atContactPoint_ = false;
    double partnerCutoff_ = std::numeric_limits<double>::infinity();
    void (*shorten_)(void*, double*) = nullptr;
    void* box_ = nullptr;
    std::vector<int> wallTypes_;
    std::vector<char> wallTransfers_;
    std::vector<char> wallKeeps_;
    std::vector<WallGain> wallGains_;
    std::vector<double> inverseSurface_;  ///< 1/(4 pi r^2) per row [m-2]
    std::vector<double> relaxationSums_;
    std::vector<double> gained_;
    std::vector<CompensatedSum> toWall_;
    double largestRelaxation_ = 0;
    WithinContact update_ = WithinContact::updated;
    double ownFieldFactor_ = 1;
    double strongFrozen_ = 0;
};

}  // namespace him
