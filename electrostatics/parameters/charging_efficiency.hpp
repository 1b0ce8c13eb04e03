// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace him {

/// What the charging law does with the charges while a contact grows, and so how kappa_c follows from a measured transfer.
enum class WithinContact {
    updated,  ///< charges change with the area: dq = D (1 - exp(-M)), the default of himFoam
    frozen    ///< charges stay as they were: dq = D M, as R20-R24 assume
};

/// The form of that name. Throws std::invalid_argument that lists the known names.
WithinContact withinContactByName(const std::string& name);
std::string nameOf(WithinContact form);

/// M [-] of a contact that moved the share s = dq/D of the charge D that would bring its two bodies to equilibrium: s when
/// frozen, -ln(1 - s) when updated. Throws std::invalid_argument unless 0 < s < 1: charge that moves against the drive or
/// beyond equilibrium has no kappa_c.
double relaxationFromShare(double share, WithinContact form);

/// One impact of a sphere at a wall.
struct WallTransfer {
    double radius = 0;            ///< [m]
    double area = 0;              ///< growth of the contact area [m2]
    double chargeTransfer = 0;    ///< charge gained by the sphere [C]
    double initialCharge = 0;     ///< [C]
    double saturationCharge = 0;  ///< [C]
};

/// kappa_c [-] of a particle-wall contact: R20 when frozen.
double efficiencyAtWall(const WallTransfer& transfer, WithinContact form);

/// One impact of two spheres i and j.
struct PairTransfer {
    double radiusI = 0;  ///< [m]
    double radiusJ = 0;
    double area = 0;            ///< growth of the contact area [m2]
    double chargeTransfer = 0;  ///< charge gained by i [C]
    double initialChargeI = 0;  ///< [C]
    double initialChargeJ = 0;
    double saturationChargeI = 0;  ///< [C], of either at the same wall
    double saturationChargeJ = 0;
};

/// kappa_c [-] of a contact of two spheres of different material or size: R21 when frozen.
double efficiencyOfPair(const PairTransfer& transfer, WithinContact form);

/// kappa_c [-] of a contact of two equal spheres, whose Gamma is zero: R22 when frozen.
/// @param initialChargeDifference  q_j - q_i [C]
double efficiencyOfSimilarPair(double radius, double area, double chargeTransfer, double initialChargeDifference,
                               WithinContact form);

/// kappa_c [-] in the limit of nearly equal charges of equal spheres: 4 pi r^2 / dA (R23). It is a swap of both charges
/// under `frozen`; `updated` moves 43 % of their difference with it.
double efficiencyOfNearlyEqualPair(double radius, double area);

/// Gamma kappa_c [V/m] of a contact whose bodies began without charge: dq / (dA epsilon0) (R24).
double limitTimesEfficiency(double area, double chargeTransfer);

/// Gamma_ij [V/m] of two spheres by their saturation charges at the same wall: (sigma_i - sigma_j)/epsilon0 (R18).
double transferLimitOfPair(double radiusI, double saturationChargeI, double radiusJ, double saturationChargeJ);

/// Contacts until an isolated sphere that starts with initialCharge has reached the share (0 to 1) of its saturation
/// charge; not rounded. 0 when it is there already, infinite without efficiency.
/// @param relaxation  M of one contact: kappa_c dA / (4 pi r^2)
double contactsToShare(double share, double relaxation, double initialCharge, double saturationCharge,
                       WithinContact form);

}  // namespace him
