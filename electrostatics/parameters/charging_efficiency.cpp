// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/charging_efficiency.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/require.hpp"

#include <limits>

namespace him {

namespace {

/// 4 pi r^2 [m2]
double surfaceOf(double radius)
{
    requirePositive("radius", radius);
    return 4.0 * pi * radius * radius;
}

/// dq/D as a number that relaxationFromShare judges: a drive of zero gives infinity.
double shareOf(double chargeTransfer, double equilibrium)
{
    return equilibrium == 0 ? std::numeric_limits<double>::infinity() : chargeTransfer / equilibrium;
}

}  // namespace

WithinContact withinContactByName(const std::string& name)
{
    if (name == "updated") {
        return WithinContact::updated;
    }
    if (name == "frozen") {
        return WithinContact::frozen;
    }
    throw std::invalid_argument("unknown form of the charging law \"" + name + "\"; known: updated, frozen");
}

std::string nameOf(WithinContact form)
{
    return form == WithinContact::updated ? "updated" : "frozen";
}

double relaxationFromShare(double share, WithinContact form)
{
    if (!std::isgreater(share, 0.0) || !std::isless(share, 1.0)) {
        rejectArgument("charge transfer over the charge that brings both bodies to equilibrium", "above 0 and below 1",
                       share);
    }
    return form == WithinContact::frozen ? share : -std::log1p(-share);
}

double efficiencyAtWall(const WallTransfer& t, WithinContact form)
{
    requirePositive("contact area", t.area);
    const double share = shareOf(t.chargeTransfer, t.saturationCharge - t.initialCharge);
    return relaxationFromShare(share, form) * surfaceOf(t.radius) / t.area;
}

double efficiencyOfPair(const PairTransfer& t, WithinContact form)
{
    requirePositive("contact area", t.area);
    const double perSurface = 1.0 / surfaceOf(t.radiusI) + 1.0 / surfaceOf(t.radiusJ);
    // R21's bracket over r_i^2 r_j^2: how far each surface charge density is from its saturation.
    const double drive = (t.saturationChargeI - t.initialChargeI) / surfaceOf(t.radiusI)
                         - (t.saturationChargeJ - t.initialChargeJ) / surfaceOf(t.radiusJ);
    return relaxationFromShare(shareOf(t.chargeTransfer, drive / perSurface), form) / (perSurface * t.area);
}

double efficiencyOfSimilarPair(double radius, double area, double chargeTransfer, double initialChargeDifference,
                               WithinContact form)
{
    return efficiencyOfPair({radius, radius, area, chargeTransfer, 0.0, initialChargeDifference, 0.0, 0.0}, form);
}

double efficiencyOfNearlyEqualPair(double radius, double area)
{
    requirePositive("contact area", area);
    return surfaceOf(radius) / area;
}

double limitTimesEfficiency(double area, double chargeTransfer)
{
    requirePositive("contact area", area);
    return chargeTransfer / (area * epsilon0);
}

double transferLimitOfPair(double radiusI, double saturationChargeI, double radiusJ, double saturationChargeJ)
{
    return (saturationChargeI / surfaceOf(radiusI) - saturationChargeJ / surfaceOf(radiusJ)) / epsilon0;
}

double contactsToShare(double share, double relaxation, double initialCharge, double saturationCharge,
                       WithinContact form)
{
    if (!std::isgreater(share, 0.0) || !std::isless(share, 1.0)) {
        rejectArgument("share of the saturation charge", "above 0 and below 1", share);
    }
    requireNotNegative("relaxation of a contact", relaxation);
    const double left = (1.0 - share) * saturationCharge / (saturationCharge - initialCharge);
    if (!(left < 1.0)) {
        return 0.0;
    }
    // Charge left to saturation after one contact, as a logarithm.
    const double perContact = form == WithinContact::updated ? -relaxation : std::log1p(-std::min(relaxation, 1.0));
    return perContact == 0 ? std::numeric_limits<double>::infinity() : std::log(left) / perContact;
}

}  // namespace him
