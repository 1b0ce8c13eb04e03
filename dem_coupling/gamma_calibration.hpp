// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace him {

/// What a run's books say of its charge.
struct ChargeSeries {
    std::vector<double> times;    ///< [s], ascending
    std::vector<double> charges;  ///< [C]
};

/// One series from those of the starts of a run, in any order: what comes after a later start counts from that start alone.
/// @param parts  none of them empty
ChargeSeries joinedSeries(std::vector<ChargeSeries> parts);

/// Charge that a run tends to, Q_0 + Q_inf of Q_0 + Q_inf (1 - exp(-a (t - t_0)/tau)) (\eq S6.1) [C]; t_0 and Q_0 are those of the
/// last values before the charge begins to change.
/// Throws std::invalid_argument for fewer than three values after that, where nothing bends, and where the run ends before tau/a.
double saturatedCharge(const ChargeSeries& series);

/// A preliminary run.
struct CalibrationRun {
    double gamma;          ///< [V/m]
    double chargePerMass;  ///< saturated [C/kg]
};

/// Gamma for a wanted charge per mass, between preliminary runs (Sippola et al. 2018, section 4.3): linear between neighbours, and
/// beyond all runs on along the last two.
class GammaCalibration {
public:
    /// Runs of one Gamma count as one, with their mean charge.
    /// Throws std::invalid_argument for fewer than two values of Gamma, and where the charge does not rise with Gamma.
    explicit GammaCalibration(std::vector<CalibrationRun> runs);

    struct Found {
        double gamma;  ///< [V/m]
        bool inside;   ///< within the runs
    };
    Found gammaFor(double chargePerMass) const;
    /// By rising Gamma.
    const std::vector<CalibrationRun>& runs() const { return runs_; }

private:
    std::vector<CalibrationRun> runs_;
};

}  // namespace him
