// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/charge_transfer.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"

#include <algorithm>
#include <cmath>

namespace him {
namespace {

double dot(const double* a, const double* b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

void ChargeTransfer::setPermittivity(double permittivity)
{
    permittivity_ = permittivity;
    coulomb_ = 1.0 / (4.0 * pi * permittivity);
}

void ChargeTransfer::setWalls(std::vector<int> types, std::vector<char> transfers)
{
    wallTypes_ = std::move(types);
    wallTransfers_ = std::move(transfers);
    toWall_.resize(wallTypes_.size());
}

double ChargeTransfer::ownField(const DemRows& rows, int row) const
{
    return surfaceField(rows.charge[row], rows.radius[row], permittivity_);
}

void ChargeTransfer::sumRelaxations(const DemRows& rows, const std::vector<GrowingPair>& pairs,
                                    const std::vector<GrowingWallContact>& wallContacts)
{
    relaxationSums_.assign(rows.all, 0.0);
    for (const GrowingPair& contact : pairs) {
        const ChargingPair& law = pairs_.of(rows.type[contact.first], rows.type[contact.second]);
        if (!law.transfers) {
            continue;
        }
        relaxationSums_[contact.first] += relaxationNumber(law.efficiency, contact.growth, rows.radius[contact.first]);
        // The owner of a ghost sums its contacts itself.
        if (contact.second < rows.local) {
            relaxationSums_[contact.second] +=
                relaxationNumber(law.efficiency, contact.growth, rows.radius[contact.second]);
        }
    }
    for (const GrowingWallContact& contact : wallContacts) {
        const ChargingPair& law = pairs_.of(rows.type[contact.particle], wallTypes_[contact.wall]);
        if (law.transfers && wallTransfers_[contact.wall]) {
            relaxationSums_[contact.particle] +=
                relaxationNumber(law.efficiency, contact.growth, rows.radius[contact.particle]);
        }
    }
}

/// E_other . n at a pair contact: the held fields of both particles without the share of their partner (same positions and
/// charges that made the field), interpolated linearly to the contact point (S2.23 with the weights the right way round).
double ChargeTransfer::fieldAtContact(const DemRows& rows, int a, int b, const double* normal) const
{
    if (!rows.held.rows) {
        return 0;
    }
    const double* heldA = rows.held.rows[a];
    const double* heldB = rows.held.rows[b];
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

void ChargeTransfer::move(const DemRows& rows, const std::vector<GrowingPair>& pairs,
                          const std::vector<GrowingWallContact>& wallContacts)
{
    gained_.assign(rows.local, 0.0);
    for (const GrowingPair& contact : pairs) {
        const bool ordered = rows.tag[contact.first] < rows.tag[contact.second];
        const int a = ordered ? contact.first : contact.second;
        const int b = ordered ? contact.second : contact.first;
        const ChargingPair& law = pairs_.of(rows.type[a], rows.type[b]);
        if (!law.transfers) {
            continue;
        }
        const double sign = ordered ? 1.0 : -1.0;
        const double normal[3] = {sign * contact.normal[0], sign * contact.normal[1], sign * contact.normal[2]};
        const double relaxation = pairRelaxation(relaxationSums_[a], relaxationSums_[b],
                                                 relaxationNumber(law.efficiency, contact.growth, rows.radius[a]),
                                                 relaxationNumber(law.efficiency, contact.growth, rows.radius[b]));
        const ContactDrive drive{law.transferLimit, ownField(rows, a), ownField(rows, b),
                                 fieldAtContact(rows, a, b, normal)};
        const double toA = chargeGained(drive, relaxation, law.efficiency, contact.growth, permittivity_);
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
        const bool seesOthers = wallField_ == WallContactField::total && rows.held.rows;
        const double fieldNormal = seesOthers ? dot(rows.held.rows[i], contact.normal) : 0.0;
        const ContactDrive drive{law.transferLimit, ownField(rows, i), 0.0, fieldNormal};
        const double gained = chargeGained(drive, relaxationSums_[i], law.efficiency, contact.growth, permittivity_);
        gained_[i] += gained;
        toWall_[contact.wall] += -gained;
        largestRelaxation_ = std::max(largestRelaxation_, relaxationSums_[i]);
    }
    for (int i = 0; i < rows.local; ++i) {
        rows.charge[i] += gained_[i];
    }
}

}  // namespace him
