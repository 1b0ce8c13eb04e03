// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charge_transfer.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>

namespace him {
namespace {

double dot(const double* a, const double* b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The held fields of partners lie apart in memory, more of them than the caches hold: contacts a few ahead are sent for.
constexpr std::size_t fetchAhead = 8;

void fetch(const double* held)
{
    __builtin_prefetch(held);
    __builtin_prefetch(held + HeldField::width - 1);
}

/// Adds to a sum and returns the part of the addend that rounding kept out of it (Knuth's two-sum).
double addRounded(double& sum, double addend)
{
    const double next = sum + addend;
    const double added = next - sum;
    const double lost = (sum - (next - added)) + (addend - added);
    sum = next;
    return lost;
}

}  // namespace

void ChargeTransfer::setPermittivity(double permittivity)
{
    permittivity_ = permittivity;
    coulomb_ = 1.0 / (4.0 * pi * permittivity);
    pairs_.resolve(permittivity);
}

void ChargeTransfer::setWalls(std::vector<int> types, std::vector<char> transfers, std::vector<char> keeps)
{
    wallTypes_ = std::move(types);
    wallTransfers_ = std::move(transfers);
    wallKeeps_ = std::move(keeps);
    wallKeeps_.resize(wallTypes_.size(), 0);
    toWall_.resize(wallTypes_.size());
}

/// Gamma_ab [V/m] of two particles.
inline double ChargeTransfer::limitOf(const DemRows& rows, const ChargingPair& law, int a, int b) const
{
    double limit = law.limit(rows.radius[a], 1 / rows.radius[b]);
    if (pairs_.spreads()) {
        limit += pairs_.spreadOf(rows.type[a], rows.tag[a]) - pairs_.spreadOf(rows.type[b], rows.tag[b]);
    }
    return limit;
}

/// chargeGained() and chargeGainedFrozen() without their checks: kappa and growth are positive here.
inline double ChargeTransfer::gainedBy(double drive, double relaxation, double rate, double growth) const
{
    const double explicitly = conductanceOf(rate, growth, permittivity_) * drive;
    return update_ == WithinContact::updated ? explicitly * relaxationFactorOf(relaxation) : explicitly;
}

void ChargeTransfer::countFrozen(double xNow, double xBefore)
{
    if (xNow > 0.5 && xBefore <= 0.5) {
        strongFrozen_ += 1;
    }
}

void ChargeTransfer::sumRelaxations(const DemRows& rows, const GrowingPairs& pairs,
                                    const std::vector<GrowingWallContact>& wallContacts)
{
    relaxationSums_.assign(rows.all, 0.0);
    inverseSurface_.resize(rows.all);
    for (int row = 0; row < rows.all; ++row) {
        inverseSurface_[row] = 1 / (4 * pi * rows.radius[row] * rows.radius[row]);
    }
    for (const GrowingPairs::Ends& contact : pairs.ends()) {
        const ChargingPair& law = pairs_.of(rows.type[contact.first], rows.type[contact.second]);
        if (!law.transfers) {
            continue;
        }
        relaxationSums_[contact.first] += numberOf(contact.first, law.rate, contact.growth);
        // The owner of a ghost sums its contacts itself.
        if (contact.second < rows.local) {
            relaxationSums_[contact.second] += numberOf(contact.second, law.rate, contact.growth);
        }
    }
    for (const GrowingWallContact& contact : wallContacts) {
        const ChargingPair& law = pairs_.of(rows.type[contact.particle], wallTypes_[contact.wall]);
        if (law.transfers && wallTransfers_[contact.wall]) {
            relaxationSums_[contact.particle] += ownFieldFactor_ * numberOf(contact.particle, law.rate, contact.growth);
        }
    }
}

/// E_other . n at a pair contact: the held fields of both particles without the share of their partner (same positions and
/// charges that made the field), interpolated linearly to the contact point (S2.23 with the weights the right way round).
double ChargeTransfer::fieldAtContact(const DemRows& rows, int a, int b, const double* normal) const
{
    const double* heldA = rows.held.row(a);
    const double* heldB = rows.held.row(b);
    double apart[3] = {heldA[3] - heldB[3], heldA[4] - heldB[4], heldA[5] - heldB[5]};
    if (shorten_) {
        shorten_(box_, apart);
    }
    const double distance = std::sqrt(dot(apart, apart));
    double along = 0;  // (x_a - x_b).n / (4 pi eps r^3) [m^-2 m/F]
    if (distance > 0 && distance <= partnerCutoff_) {
        along = coulomb_ * dot(apart, normal) / (distance * distance * distance);
    }
    const double fieldA = dot(heldA, normal) - heldB[6] * along;
    const double fieldB = dot(heldB, normal) + heldA[6] * along;
    return (rows.radius[b] * fieldA + rows.radius[a] * fieldB) / (rows.radius[a] + rows.radius[b]);
}

void ChargeTransfer::move(const DemRows& rows, const GrowingPairs& pairs,
                          const std::vector<GrowingWallContact>& wallContacts)
{
    gained_.assign(rows.local, 0.0);
    wallGains_.clear();
    const bool frozen = update_ == WithinContact::frozen;
    const std::size_t contacts = pairs.ends().size();
    for (std::size_t n = 0; n < contacts; ++n) {
        if (rows.held.first && n + fetchAhead < contacts) {
            const GrowingPairs::Ends& later = pairs.ends()[n + fetchAhead];
            fetch(rows.held.row(later.first));
            fetch(rows.held.row(later.second));
        }
        const GrowingPairs::Ends& contact = pairs.ends()[n];
        const bool ordered = rows.tag[contact.first] < rows.tag[contact.second];
        const int a = ordered ? contact.first : contact.second;
        const int b = ordered ? contact.second : contact.first;
        const ChargingPair& law = pairs_.of(rows.type[a], rows.type[b]);
        if (!law.transfers) {
            continue;
        }
        const double relaxation =
            pairRelaxation(relaxationSums_[a], relaxationSums_[b], numberOf(a, law.rate, contact.growth),
                           numberOf(b, law.rate, contact.growth));
        // What this contact has moved so far does not count when charges are frozen within it.
        double* const kept = frozen ? pairs.within(n).moved : nullptr;
        const double moved = kept ? *kept : 0;
        double drive = limitOf(rows, law, a, b) - surfaceFieldOf(a, rows.charge[a] - moved)
                       + surfaceFieldOf(b, rows.charge[b] + moved);
        if (rows.held.first) {
            const double sign = ordered ? 1.0 : -1.0;
            const double* const along = pairs.normal(n);
            const double normal[3] = {sign * along[0], sign * along[1], sign * along[2]};
            drive -= fieldAtContact(rows, a, b, normal);
        }
        const double toA = gainedBy(drive, relaxation, law.rate, contact.growth);
        if (frozen) {
            if (kept) {
                *kept += toA;
            }
            if (a < rows.local) {
                const double area = pairs.within(n).area;
                const int smaller = rows.radius[a] < rows.radius[b] ? a : b;
                countFrozen(numberOf(smaller, law.rate, area),
                            numberOf(smaller, law.rate, std::max(area - contact.growth, 0.0)));
            }
        }
        if (a < rows.local) {
            gained_[a] += toA;
        }
        if (b < rows.local) {
            gained_[b] -= toA;
        }
        largestRelaxation_ = std::max(largestRelaxation_, relaxation);
    }
    for (const GrowingWallContact& contact : wallContacts) {
        const int i = contact.particle;
        const ChargingPair& law = pairs_.of(rows.type[i], wallTypes_[contact.wall]);
        if (!law.transfers || !wallTransfers_[contact.wall]) {
            continue;
        }
        const bool seesOthers = wallField_ == WallContactField::total && rows.held.first;
        double fieldNormal = 0;
        if (seesOthers && atContactPoint_) {
            fieldNormal = contact.fieldNormal;
        } else if (seesOthers) {
            // Gamma is calibrated without the walls' response to the particle's own charge (R17), so it is left out.
            const double* held = rows.held.row(i);
            fieldNormal = dot(held, contact.normal) - dot(held + HeldField::ownResponse, contact.normal);
        }
        const double moved = frozen && contact.moved ? *contact.moved : 0;
        double limit = law.limit(rows.radius[i], 0);
        if (pairs_.spreads()) {
            limit += pairs_.spreadOf(rows.type[i], rows.tag[i]);
        }
        const double drive = limit - ownFieldFactor_ * surfaceFieldOf(i, rows.charge[i] - moved) - fieldNormal;
        const double gained = gainedBy(drive, relaxationSums_[i], law.rate, contact.growth);
        if (frozen) {
            if (contact.moved) {
                *contact.moved += gained;
            }
            const double before = std::max(contact.area - contact.growth, 0.0);
            countFrozen(ownFieldFactor_ * numberOf(i, law.rate, contact.area),
                        ownFieldFactor_ * numberOf(i, law.rate, before));
        }
        gained_[i] += gained;
        toWall_[contact.wall] += -gained;
        if (wallKeeps_[contact.wall]) {
            wallGains_.push_back({i, contact.wall, {contact.normal[0], contact.normal[1], contact.normal[2]}, -gained});
        }
        largestRelaxation_ = std::max(largestRelaxation_, relaxationSums_[i]);
    }
    // What rounding keeps from a particle stays with the wall. Close to saturation every step would lose a gain below the last
    // digit of the charge, always with the same sign.
    for (int i = 0; i < rows.local; ++i) {
        gained_[i] = addRounded(rows.charge[i], gained_[i]);
    }
    std::size_t gain = 0;  // those of the loop above, in the same order
    for (const GrowingWallContact& contact : wallContacts) {
        if (wallTransfers_[contact.wall]
            && pairs_.of(rows.type[contact.particle], wallTypes_[contact.wall]).transfers) {
            toWall_[contact.wall] += gained_[contact.particle];
            if (wallKeeps_[contact.wall]) {
                wallGains_[gain++].charge += gained_[contact.particle];
            }
            gained_[contact.particle] = 0;
        }
    }
}

}  // namespace him
