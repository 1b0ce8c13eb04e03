// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrateGamma/calibrationRuns.H"

#include "electrostatics/text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace him {

namespace {

double numberFrom(const std::string& word)
{
    const std::optional<double> number = finiteNumber(word);
    if (!number) {
        throw std::invalid_argument("found " + word + " in place of a number");
    }
    return *number;
}

/// Columns Time [s] and total [C] of a charge.dat.
ChargeSeries readSeries(const std::filesystem::path& path)
{
    std::ifstream file(path);
    if (!file) {
        throw std::invalid_argument("the file " + path.string() + " cannot be read");
    }
    ChargeSeries series;
    std::vector<std::string> names;
    for (std::string line; std::getline(file, line);) {
        if (!line.empty() && line.front() == '#') {
            names = wordsOf(line.substr(1));
            continue;
        }
        const std::vector<std::string> words = wordsOf(line);
        if (words.empty()) {
            continue;
        }
        const auto column = [&](const char* name) {
            const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
            if (at == names.size()) {
                throw std::invalid_argument(path.filename().string() + " has no columns Time and total");
            }
            if (at >= words.size()) {
                throw std::invalid_argument(path.filename().string() + " has a line that is too short: " + line);
            }
            return numberFrom(words[at]);
        };
        series.times.push_back(column("Time"));
        series.charges.push_back(column("total"));
    }
    if (series.times.empty()) {
        throw std::invalid_argument(path.filename().string() + " has no lines");
    }
    return series;
}

CalibrationRun readRun(const std::vector<std::string>& words, const std::filesystem::path& folder)
{
    if (words.size() < 2) {
        throw std::invalid_argument(
            "found one word; allowed are 2 (Gamma, charge per mass) or 3 and more (Gamma, charge.dat ..., mass)");
    }
    CalibrationRun run{numberFrom(words.front()), 0};
    if (words.size() == 2) {
        run.chargePerMass = numberFrom(words[1]);
        return run;
    }
    const double mass = numberFrom(words.back());
    if (!(mass > 0)) {
        throw std::invalid_argument("a mass of " + words.back() + " kg is not positive");
    }
    std::vector<ChargeSeries> parts;
    for (std::size_t n = 1; n + 1 < words.size(); ++n) {
        parts.push_back(readSeries(folder / words[n]));
    }
    run.chargePerMass = saturatedCharge(joinedSeries(std::move(parts))) / mass;
    return run;
}

}  // namespace

std::optional<double> finiteNumber(const std::string& word)
{
    try {
        std::size_t used = 0;
        const double number = std::stod(word, &used);
        if (used == word.size() && std::isfinite(number)) {
            return number;
        }
    } catch (const std::logic_error&) {
    }
    return std::nullopt;
}

std::vector<CalibrationRun> readCalibrationRuns(const std::string& table, Complaints& complaints)
{
    std::vector<CalibrationRun> runs;
    std::ifstream file(table);
    if (!file) {
        complaints.add(table, "the file cannot be read.");
        return runs;
    }
    long number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        const std::vector<std::string> words = wordsOf(line.substr(0, line.find('#')));
        if (words.empty()) {
            continue;
        }
        try {
            runs.push_back(readRun(words, std::filesystem::path(table).parent_path()));
        } catch (const std::invalid_argument& fault) {
            complaints.add(table + ": line " + std::to_string(number), std::string(fault.what()) + ".");
        }
    }
    return runs;
}

}  // namespace him
