// SPDX-License-Identifier: GPL-3.0-or-later
#include "chargingParameters/sizeLawEntries.H"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <set>

namespace him {

namespace {

const namedMeasurement* find(const std::vector<namedMeasurement>& measurements, const std::string& name)
{
    const auto found = std::find_if(measurements.begin(), measurements.end(),
                                    [&](const namedMeasurement& m) { return m.name == name; });
    return found == measurements.end() ? nullptr : &*found;
}

bool holdsWallLimit(const Measurement& m)
{
    return m.atWall && (m.particle.saturationCharge || m.particle.transferLimit || !m.historyCharges.empty());
}

/// A published interval has no other extremes than its ends.
Estimate asEstimate(const Measured& m)
{
    return {m.value, m.lower, m.upper, m.lower, m.upper};
}

void checkOrder(const checkedDictionary& section, const std::string& entry, const Measured& m)
{
    if (!(m.lower <= m.value && m.value <= m.upper)) {
        section.complain(entry, "the average, " + shown(m.value) + ", must be within its interval, " + shown(m.lower)
                                    + " to " + shown(m.upper) + ".");
    }
}

publishedSize readPublished(checkedDictionary section, const std::string& name)
{
    publishedSize size;
    size.name = name;
    size.radius = measuredEntry(section, "radius", 1);
    if (!(size.radius.lower > 0)) {
        section.complain("radius", "found " + shown(size.radius.lower) + " m, but a radius above zero is expected.");
    }
    size.transferLimit = measuredEntry(section, "transferLimit", 1);
    checkOrder(section, "radius", size.radius);
    checkOrder(section, "transferLimit", size.transferLimit);
    if (section.has("efficiency")) {
        size.efficiency = measuredEntry(section, "efficiency", 1);
        checkOrder(section, "efficiency", *size.efficiency);
        if (!(size.efficiency->lower >= 0)) {
            section.complain("efficiency",
                             "found " + shown(size.efficiency->lower) + ", but kappa_c is never negative.");
        }
    }
    section.refuseUnknownEntries();
    return size;
}

Estimate charges(const Estimate& limit, double radius)
{
    const double factor = 4.0 * pi * epsilon0 * radius * radius;  // R17
    return {factor * limit.value, factor * limit.lower95, factor * limit.upper95, factor * limit.minimum,
            factor * limit.maximum};
}

}  // namespace

std::optional<sizeLawRequest> readSizeLaw(checkedDictionary& dictionary,
                                          const std::vector<namedMeasurement>& measurements)
{
    if (!dictionary.has("sizeLaw")) {
        return {};
    }
    checkedDictionary section = dictionary.section("sizeLaw");
    sizeLawRequest request;
    std::set<double> radii;
    request.measurements = section.names("measurements");
    for (const std::string& name : request.measurements) {
        const namedMeasurement* m = find(measurements, name);
        if (!m) {
            std::vector<std::string> known;
            for (const namedMeasurement& each : measurements) {
                known.push_back(each.name);
            }
            section.complain("measurements", "unknown name `" + name + "`; known: " + joined(known) + ".");
        } else if (!holdsWallLimit(m->measured)) {
            section.complain("measurements",
                             name
                                 + " gives no Gamma at a wall, and the size law (R19) is one of Gamma at a wall. "
                                   "It needs contact particleWall and a saturation charge or readings.");
        } else {
            radii.insert(m->measured.particle.radius.value);
        }
    }
    checkedDictionary published = section.section("published", true);
    for (const std::string& name : published.sections()) {
        request.published.push_back(readPublished(published.section(name), name));
        radii.insert(request.published.back().radius.value);
    }
    published.refuseUnknownEntries();
    if (section.readable() && radii.size() < 2) {
        dictionary.complain("sizeLaw",
                            "a law through " + std::to_string(radii.size())
                                + " different radii is no law. Name measurements of two or more sizes, or give "
                                  "published ones.");
    }
    request.radii = section.numbers("predict");
    for (const double radius : request.radii) {
        if (!(radius > 0)) {
            section.complain("predict", "found " + shown(radius) + " m, but radii above zero are expected.");
        }
    }
    section.refuseUnknownEntries();
    return request;
}

sizeLawResult solveSizeLaw(const sizeLawRequest& request, const std::vector<namedMeasurement>& measurements,
                           const std::vector<ChargingParameters>& parameters)
{
    std::vector<SizePoint> points;
    std::vector<Estimate> efficiencies;
    for (const std::string& name : request.measurements) {
        const namedMeasurement* m = find(measurements, name);
        const ChargingParameters& p = parameters[static_cast<std::size_t>(m - measurements.data())];
        points.push_back({m->measured.particle.radius.value, *p.transferLimit});
        if (p.efficiencyUpdated) {
            efficiencies.push_back(*p.efficiencyUpdated);
        }
    }
    for (const publishedSize& size : request.published) {
        points.push_back({size.radius.value, asEstimate(size.transferLimit)});
        if (size.efficiency) {
            efficiencies.push_back(asEstimate(*size.efficiency));
        }
    }
    std::vector<double> radii, limits;
    for (const SizePoint& point : points) {
        radii.push_back(point.radius);
        limits.push_back(point.transferLimit.value);
    }
    sizeLawResult result;
    result.law = fitSizeLaw(radii, limits);
    result.sizes = points.size();
    for (const double radius : request.radii) {
        sizePrediction prediction;
        prediction.radius = radius;
        prediction.transferLimit = predictedTransferLimit(points, radius);
        prediction.saturationCharge = charges(prediction.transferLimit, radius);
        if (efficiencies.size() == points.size()) {
            prediction.efficiency = predictedEfficiency(efficiencies);
        }
        result.predictions.push_back(prediction);
    }
    return result;
}

}  // namespace him
