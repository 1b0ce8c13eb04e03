// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gamma_calibration.hpp"

#include "dem_coupling/statistics/saturation_curve.hpp"
#include "electrostatics/text.hpp"

#include <algorithm>
#include <stdexcept>

namespace him {

ChargeSeries joinedSeries(std::vector<ChargeSeries> parts)
{
    std::sort(parts.begin(), parts.end(),
              [](const ChargeSeries& a, const ChargeSeries& b) { return a.times.front() < b.times.front(); });
    ChargeSeries all;
    for (const ChargeSeries& part : parts) {
        const auto kept = std::lower_bound(all.times.begin(), all.times.end(), part.times.front()) - all.times.begin();
        all.times.resize(static_cast<std::size_t>(kept));
        all.charges.resize(static_cast<std::size_t>(kept));
        all.times.insert(all.times.end(), part.times.begin(), part.times.end());
        all.charges.insert(all.charges.end(), part.charges.begin(), part.charges.end());
    }
    return all;
}

double saturatedCharge(const ChargeSeries& series)
{
    std::size_t begin = 0;
    while (begin + 1 < series.charges.size() && series.charges[begin + 1] == series.charges.front()) {
        ++begin;
    }
    std::vector<double> times, charges;
    for (std::size_t n = begin + 1; n < series.times.size(); ++n) {
        times.push_back(series.times[n] - series.times[begin]);
        charges.push_back(series.charges[n] - series.charges[begin]);
    }
    if (times.size() < 3) {
        throw std::invalid_argument("fewer than three lines after the charge begins to change");
    }
    const SaturationCurve curve = fitSaturationCurve(times, charges);
    if (!curve.known) {
        throw std::invalid_argument("the charge shows no saturation yet; run longer");
    }
    if (curve.timeScale > times.back()) {
        throw std::invalid_argument("the run ends before its charging time, tau/a = " + shown(curve.timeScale)
                                    + " s; run longer");
    }
    return series.charges[begin] + curve.limit;
}

GammaCalibration::GammaCalibration(std::vector<CalibrationRun> runs)
{
    std::sort(runs.begin(), runs.end(),
              [](const CalibrationRun& a, const CalibrationRun& b) { return a.gamma < b.gamma; });
    for (auto run = runs.begin(); run != runs.end();) {
        const auto end =
            std::find_if(run, runs.end(), [&](const CalibrationRun& other) { return other.gamma != run->gamma; });
        CalibrationRun mean{run->gamma, 0};
        for (auto one = run; one != end; ++one) {
            mean.chargePerMass += one->chargePerMass / static_cast<double>(end - run);
        }
        runs_.push_back(mean);
        run = end;
    }
    if (runs_.size() < 2) {
        throw std::invalid_argument("at least two runs with different Gamma are needed");
    }
    for (std::size_t n = 1; n < runs_.size(); ++n) {
        if (!(runs_[n].chargePerMass > runs_[n - 1].chargePerMass)) {
            throw std::invalid_argument("the charge per mass does not rise from Gamma = " + shown(runs_[n - 1].gamma)
                                        + " V/m (" + shown(runs_[n - 1].chargePerMass) + " C/kg) to "
                                        + shown(runs_[n].gamma) + " V/m (" + shown(runs_[n].chargePerMass)
                                        + " C/kg): nothing can be read off between them");
        }
    }
}

GammaCalibration::Found GammaCalibration::gammaFor(double chargePerMass) const
{
    std::size_t n = 1;
    while (n + 1 < runs_.size() && chargePerMass > runs_[n].chargePerMass) {
        ++n;
    }
    const CalibrationRun &low = runs_[n - 1], &high = runs_[n];
    const double share = (chargePerMass - low.chargePerMass) / (high.chargePerMass - low.chargePerMass);
    return {low.gamma + share * (high.gamma - low.gamma),
            chargePerMass >= runs_.front().chargePerMass && chargePerMass <= runs_.back().chargePerMass};
}

}  // namespace him
