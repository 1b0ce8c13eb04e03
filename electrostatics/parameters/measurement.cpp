// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/measurement.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"
#include "electrostatics/parameters/saturation_fit.hpp"

#include <cmath>

namespace him {

namespace {

constexpr double saturated = 0.95;

/// The inputs of all formulas in one order.
enum Input { radiusI, radiusJ, areaOrSpeed, transfer, chargeI, chargeJ, saturationI, saturationJ, decay, inputCount };

class Formulas {
public:
    explicit Formulas(const Measurement& measurement) : m_(measurement), inputs_(inputCount, Measured::exact(0))
    {
        inputs_[radiusI] = m_.particle.radius;
        inputs_[radiusJ] = m_.similar ? Measured::exact(0) : m_.partner.radius;
        inputs_[areaOrSpeed] = m_.area ? *m_.area : m_.normalSpeed.value_or(Measured::exact(0));
        inputs_[transfer] = m_.chargeTransfer.value_or(Measured::exact(0));
        inputs_[chargeI] = m_.particle.initialCharge;
        inputs_[chargeJ] = m_.partner.initialCharge;
        inputs_[saturationI] = saturationOf(m_.particle);
        inputs_[saturationJ] = saturationOf(m_.partner);
    }

    void setHistory(const SaturationFit& fit)
    {
        inputs_[saturationI] = fit.saturationCharge;
        inputs_[decay] = fit.decay;
    }

    Estimate of(double (Formulas::*formula)(const std::vector<double>&) const) const
    {
        return estimate(inputs_, [&](const std::vector<double>& x) { return (this->*formula)(x); });
    }

    Estimate of(double (Formulas::*formula)(const std::vector<double>&, WithinContact) const, WithinContact form) const
    {
        return estimate(inputs_, [&](const std::vector<double>& x) { return (this->*formula)(x, form); });
    }

    double area(const std::vector<double>& x) const
    {
        if (m_.area) {
            return x[areaOrSpeed];
        }
        const ImpactBody i{x[radiusI], m_.particle.density, m_.particle.elasticity};
        if (m_.atWall) {
            return impactAreaAtWall(i, m_.wall, x[areaOrSpeed], m_.areaLaw);
        }
        const ImpactBody j{x[radiusJ], m_.partner.density, m_.partner.elasticity};
        return impactAreaOfSpheres(i, m_.similar ? i : j, x[areaOrSpeed], m_.areaLaw);
    }

    double saturation(const std::vector<double>& x) const
    {
        return saturationAt(m_.particle, x[saturationI], x[radiusI]);
    }
    double wallLimit(const std::vector<double>& x) const { return surfaceField(saturation(x), x[radiusI], epsilon0); }
    double pairLimit(const std::vector<double>& x) const
    {
        return transferLimitOfPair(x[radiusI], saturation(x), x[radiusJ],
                                   saturationAt(m_.partner, x[saturationJ], x[radiusJ]));
    }
    double product(const std::vector<double>& x) const { return him::limitTimesEfficiency(area(x), x[transfer]); }

    double wallEfficiency(const std::vector<double>& x, WithinContact form) const
    {
        return efficiencyAtWall({x[radiusI], area(x), x[transfer], x[chargeI], saturation(x)}, form);
    }
    double wallContacts(const std::vector<double>& x) const
    {
        const double share = x[transfer] / (saturation(x) - x[chargeI]);
        return std::log(1.0 - saturated) / std::log1p(-share);
    }
    double historyEfficiency(const std::vector<double>& x, WithinContact form) const
    {
        const double relaxation = form == WithinContact::updated ? x[decay] : -std::expm1(-x[decay]);
        return relaxation * 4.0 * pi * x[radiusI] * x[radiusI] / area(x);
    }
    double historyContacts(const std::vector<double>& x) const { return -std::log(1.0 - saturated) / x[decay]; }
    double pairEfficiency(const std::vector<double>& x, WithinContact form) const
    {
        return efficiencyOfPair({x[radiusI], x[radiusJ], area(x), x[transfer], x[chargeI], x[chargeJ], saturation(x),
                                 saturationAt(m_.partner, x[saturationJ], x[radiusJ])},
                                form);
    }
    double similarEfficiency(const std::vector<double>& x, WithinContact form) const
    {
        return efficiencyOfSimilarPair(x[radiusI], area(x), x[transfer], x[chargeJ] - x[chargeI], form);
    }
    double nearlyEqualEfficiency(const std::vector<double>& x) const
    {
        return efficiencyOfNearlyEqualPair(x[radiusI], area(x));
    }

private:
    static Measured saturationOf(const MeasuredBody& body)
    {
        return body.transferLimit ? *body.transferLimit : body.saturationCharge.value_or(Measured::exact(0));
    }
    static double saturationAt(const MeasuredBody& body, double given, double radius)
    {
        return body.transferLimit ? him::saturationCharge(given, radius, epsilon0) : given;
    }

    const Measurement& m_;
    std::vector<Measured> inputs_;
};

bool knowsSaturation(const MeasuredBody& body)
{
    return body.saturationCharge || body.transferLimit;
}

void addBothEfficiencies(ChargingParameters& result, const Formulas& formulas,
                         double (Formulas::*formula)(const std::vector<double>&, WithinContact) const)
{
    result.efficiencyUpdated = formulas.of(formula, WithinContact::updated);
    result.efficiencyFrozen = formulas.of(formula, WithinContact::frozen);
}

void addWallParameters(ChargingParameters& result, const Measurement& m, Formulas& formulas)
{
    if (result.branch == Branch::particleWallWithoutSaturation) {
        result.limitTimesEfficiency = formulas.of(&Formulas::product);
        return;
    }
    if (result.branch == Branch::particleWallHistory) {
        formulas.setHistory(fitSaturation(m.historyContacts, m.historyCharges));
        addBothEfficiencies(result, formulas, &Formulas::historyEfficiency);
        result.contactsTo95 = formulas.of(&Formulas::historyContacts);
    }
    if (result.branch == Branch::particleWall) {
        addBothEfficiencies(result, formulas, &Formulas::wallEfficiency);
        result.contactsTo95 = formulas.of(&Formulas::wallContacts);
    }
    result.saturationCharge = formulas.of(&Formulas::saturation);
    result.transferLimit = formulas.of(&Formulas::wallLimit);
}

void addPairParameters(ChargingParameters& result, const Formulas& formulas)
{
    switch (result.branch) {
    case Branch::dissimilarPairWithoutSaturation:
        result.limitTimesEfficiency = formulas.of(&Formulas::product);
        return;
    case Branch::similarPair:
        result.transferLimit = Estimate{};
        addBothEfficiencies(result, formulas, &Formulas::similarEfficiency);
        return;
    case Branch::similarPairNearlyEqual:
        result.transferLimit = Estimate{};
        result.efficiencyFrozen = formulas.of(&Formulas::nearlyEqualEfficiency);
        return;
    case Branch::dissimilarPair:
        addBothEfficiencies(result, formulas, &Formulas::pairEfficiency);
        break;
    default:
        break;
    }
    result.saturationCharge = formulas.of(&Formulas::saturation);
    result.transferLimit = formulas.of(&Formulas::pairLimit);
}

}  // namespace

Branch branchOf(const Measurement& m)
{
    KnownQuantities known;
    known.atWall = m.atWall;
    known.similar = m.similar;
    known.saturation = knowsSaturation(m.particle) && (m.atWall || knowsSaturation(m.partner));
    known.chargeTransfer = m.chargeTransfer.has_value();
    known.chargeDifference = m.partner.initialCharge.value != m.particle.initialCharge.value;
    known.history = !m.historyCharges.empty();
    return chooseBranch(known);
}

ChargingParameters parametersOf(const Measurement& m)
{
    ChargingParameters result;
    result.branch = branchOf(m);
    Formulas formulas(m);
    if (m.area || m.normalSpeed) {
        result.contactArea = formulas.of(&Formulas::area);
    }
    if (m.atWall) {
        addWallParameters(result, m, formulas);
    } else {
        addPairParameters(result, formulas);
    }
    return result;
}

}  // namespace him
