// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/contact_charging.hpp"
#include "electrostatics/parameters/measurement.hpp"
#include "electrostatics/text.hpp"

#include <cmath>

namespace him {

namespace {

class FaultList {
public:
    explicit FaultList(const Measurement& measurement) : m_(measurement) {}

    std::vector<std::string> all()
    {
        positive("particle radius", m_.particle.radius, "m");
        if (!m_.atWall && !m_.similar) {
            positive("partner radius", m_.partner.radius, "m");
        }
        ordered("initial charge of the particle", m_.particle.initialCharge);
        ordered("initial charge of the partner", m_.partner.initialCharge);
        Branch branch;
        try {
            branch = branchOf(m_);
        } catch (const std::exception& missing) {
            add(std::string(missing.what()) + ": give one of them");
            return faults_;
        }
        contact(branch);
        const bool lengthsAreRight = faults_.empty();
        saturation("particle", m_.particle);
        if (!m_.atWall && !m_.similar) {
            saturation("partner", m_.partner);
        }
        if (m_.chargeTransfer) {
            ordered("charge transfer", *m_.chargeTransfer);
            if (lengthsAreRight) {
                transferFaults(branch);
            }
        }
        return faults_;
    }

private:
    void add(const std::string& fault) { faults_.push_back(fault); }

    void ordered(const std::string& what, const Measured& x)
    {
        if (!(std::isfinite(x.lower) && std::isfinite(x.upper) && x.lower <= x.value && x.value <= x.upper)) {
            add("the average of the " + what + ", " + shown(x.value) + ", must be within its interval, "
                + shown(x.lower) + " to " + shown(x.upper));
        }
    }

    void positive(const std::string& what, const Measured& x, const std::string& unit)
    {
        ordered(what, x);
        if (!std::isgreater(x.lower, 0.0)) {
            add("the " + what + " and its whole interval must be above zero, found " + shown(x.lower) + " " + unit);
        }
    }

    /// Area and speed; needed by every branch with a kappa_c.
    void contact(Branch branch)
    {
        if (m_.area) {
            positive("contact area", *m_.area, "m2");
        }
        if (m_.normalSpeed) {
            positive("normal speed", *m_.normalSpeed, "m/s");
        }
        const bool needed =
            branch != Branch::particleWallSaturationOnly && branch != Branch::dissimilarPairSaturationOnly;
        if (needed && !m_.area && !m_.normalSpeed) {
            add("a contact area is needed for " + nameOf(branch) + ", from a DEM run or from the speed of the impact");
        }
    }

    static double saturationOf(const MeasuredBody& body)
    {
        return body.transferLimit ? saturationCharge(body.transferLimit->value, body.radius.value, epsilon0)
                                  : body.saturationCharge->value;
    }

    void saturation(const std::string& who, const MeasuredBody& body)
    {
        if (!body.saturationCharge && !body.transferLimit) {
            return;
        }
        const Measured& given = body.transferLimit ? *body.transferLimit : *body.saturationCharge;
        ordered(body.transferLimit ? "Gamma of the " + who : "saturation charge of the " + who, given);
        if (given.value == 0 || !std::isgreater(body.radius.lower, 0.0)) {
            return;
        }
        const double limit = saturationOf(body);
        const double charge = body.initialCharge.value;
        if (charge * limit > 0 && std::abs(charge) >= std::abs(limit)) {
            add("the " + who + " begins with " + shown(charge) + " C, beyond its saturation charge of " + shown(limit)
                + " C: it could not have gained charge on from there");
        }
    }

    void transferFaults(Branch branch)
    {
        const double gained = m_.chargeTransfer->value;
        if (gained == 0) {
            add("the charge transfer is 0 C: a contact that moves nothing holds no kappa_c");
            return;
        }
        if (branch == Branch::particleWallWithoutSaturation || branch == Branch::dissimilarPairWithoutSaturation) {
            if (m_.particle.initialCharge.value != 0 || m_.partner.initialCharge.value != 0) {
                add("without a saturation charge, R24 holds for particles that begin without charge, found "
                    + shown(m_.particle.initialCharge.value)
                    + (m_.atWall ? "" : " and " + shown(m_.partner.initialCharge.value))
                    + " C: give the saturation charge, or readings of neutralised particles");
            }
            return;
        }
        if (branch == Branch::similarPairNearlyEqual || branch == Branch::particleWallHistory) {
            return;
        }
        const double equilibrium = chargeToEquilibrium(branch);
        if (gained * equilibrium <= 0) {
            add("the charge transfer of " + shown(gained)
                + " C has the wrong sign: with these charges the particle can gain "
                + (equilibrium == 0 ? std::string("nothing")
                                    : std::string(equilibrium > 0 ? "positive" : "negative") + " charge only, up to "
                                          + shown(equilibrium) + " C"));
        } else if (std::abs(gained) >= std::abs(equilibrium)) {
            add("the charge transfer of " + shown(gained) + " C is more than the " + shown(equilibrium)
                + " C that bring " + (m_.atWall ? "the particle to saturation" : "both particles to equilibrium"));
        }
    }

    /// Charge [C] that the particle would gain in a contact without end.
    double chargeToEquilibrium(Branch branch) const
    {
        if (branch == Branch::similarPair) {
            return (m_.partner.initialCharge.value - m_.particle.initialCharge.value) / 2;
        }
        const double left = saturationOf(m_.particle) - m_.particle.initialCharge.value;
        if (m_.atWall) {
            return left;
        }
        const double squareI = m_.particle.radius.value * m_.particle.radius.value;
        const double squareJ = m_.partner.radius.value * m_.partner.radius.value;
        const double leftJ = saturationOf(m_.partner) - m_.partner.initialCharge.value;
        return (left / squareI - leftJ / squareJ) / (1 / squareI + 1 / squareJ);
    }

    const Measurement& m_;
    std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> faultsOf(const Measurement& measurement)
{
    return FaultList(measurement).all();
}

}  // namespace him
