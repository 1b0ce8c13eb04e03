// SPDX-License-Identifier: GPL-3.0-or-later
#include "chargingParameters/parameterTable.H"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace him {

namespace {

struct quantity {
    std::string name;
    std::string unit;
    Estimate estimate;
};

void add(std::vector<quantity>& all, const std::string& name, const std::string& unit, const std::optional<Estimate>& e)
{
    if (e) {
        all.push_back({name, unit, *e});
    }
}

std::vector<quantity> quantitiesOf(const ChargingParameters& p)
{
    std::vector<quantity> all;
    add(all, "contact area", "m2", p.contactArea);
    add(all, "Gamma", "V/m", p.transferLimit);
    add(all, "saturation charge", "C", p.saturationCharge);
    add(all, "kappa_c", "-", p.efficiencyUpdated);
    add(all, "kappa_c frozen", "-", p.efficiencyFrozen);
    add(all, "Gamma kappa_c", "V/m", p.limitTimesEfficiency);
    add(all, "contacts to 95 %", "-", p.contactsTo95);
    return all;
}

std::vector<quantity> quantitiesOf(const sizePrediction& p)
{
    std::vector<quantity> all;
    add(all, "Gamma", "V/m", p.transferLimit);
    add(all, "saturation charge", "C", p.saturationCharge);
    add(all, "kappa_c", "-", p.efficiency);
    return all;
}

std::string row(const char* format, const std::string& name, const std::string& a, const std::string& b,
                const std::string& c, const std::string& d, const std::string& e)
{
    char line[200];
    std::snprintf(line, sizeof line, format, name.c_str(), a.c_str(), b.c_str(), c.c_str(), d.c_str(), e.c_str());
    return line;
}

std::string table(const std::vector<quantity>& quantities)
{
    const char* format = "    %-24s %12s   %12s %12s   %12s %12s\n";
    std::string text = row(format, "", "average", "95 % from", "to", "minimum", "maximum");
    for (const quantity& q : quantities) {
        const Estimate& e = q.estimate;
        text += row(format, q.name + " [" + q.unit + "]", shown(e.value, 5), shown(e.lower95, 5), shown(e.upper95, 5),
                    shown(e.minimum, 5), shown(e.maximum, 5));
    }
    return text;
}

/// The way through R Fig. 3 in words: the answers to its questions.
std::string questions(const Measurement& m)
{
    const bool saturation = m.particle.saturationCharge || m.particle.transferLimit;
    std::string text = m.atWall ? "particle-wall" : m.similar ? "similar particles" : "dissimilar particles";
    if (!m.historyCharges.empty()) {
        return text + ", " + std::to_string(m.historyCharges.size()) + " readings of the charge";
    }
    if (m.atWall) {
        text += saturation ? ", saturation known" : ", saturation unknown";
    } else if (!m.similar) {
        const bool both = saturation && (m.partner.saturationCharge || m.partner.transferLimit);
        text += both ? ", both saturations known" : ", saturations not both known";
    } else if (m.partner.initialCharge.value == m.particle.initialCharge.value) {
        text += ", charges equal";
    } else {
        text += ", charges differ";
    }
    return text + (m.chargeTransfer ? ", charge transfer known" : ", charge transfer unknown");
}

std::string areaSource(const Measurement& m)
{
    if (m.area) {
        return "as given";
    }
    if (!m.normalSpeed) {
        return "not asked for";
    }
    const std::string speed = "elastic impact at " + shown(m.normalSpeed->value) + " m/s on ";
    return speed + (m.atWall ? (m.wall ? "an elastic wall" : "a rigid wall") : "a sphere") + ", area law "
           + nameOf(m.areaLaw);
}

/// A pair's line for fix charge/gran/contact, or what is missing for one.
std::string pairWords(long i, long j, double limit, double efficiency)
{
    return "pair " + std::to_string(i) + " " + std::to_string(j) + " gamma " + shown(limit) + " kappa "
           + shown(efficiency);
}

bool exact(const Estimate& e)
{
    return e.minimum == e.maximum;
}

std::string withBands(const std::string& name, long i, long j, const Estimate& limit, const Estimate& efficiency)
{
    const std::string average = pairWords(i, j, limit.value, efficiency.value) + "\n";
    if (exact(limit) && exact(efficiency)) {
        return "# " + name + "\n" + average;
    }
    // The weakest drive has the smallest |Gamma|, whatever its sign.
    const bool negative = limit.value < 0;
    const double weakest = negative ? limit.maximum : limit.minimum;
    const double strongest = negative ? limit.minimum : limit.maximum;
    return "# " + name + ": average, and the parameters that charge least and most\n" + average
           + "# least: " + pairWords(i, j, weakest, efficiency.minimum) + "\n"
           + "# most:  " + pairWords(i, j, strongest, efficiency.maximum) + "\n";
}

/// R23 defines its kappa_c for charges that are frozen within a contact, and there is no other form of it.
bool needsFrozen(const ChargingParameters& p)
{
    return p.transferLimit && p.efficiencyFrozen && !p.efficiencyUpdated;
}

/// @param frozen  write kappa_c for `update frozen`, which holds for all pairs of the fix
std::string entryOf(const namedMeasurement& m, const ChargingParameters& p, bool frozen)
{
    const std::optional<Estimate>& efficiency = frozen ? p.efficiencyFrozen : p.efficiencyUpdated;
    if (p.transferLimit && efficiency) {
        return withBands(m.name, m.typeI, m.typeJ, *p.transferLimit, *efficiency);
    }
    if (p.transferLimit) {
        return "# " + m.name + ": Gamma " + shown(p.transferLimit->value)
               + " V/m, but no kappa_c without a charge transfer\n";
    }
    return "# " + m.name + ": Gamma kappa_c " + shown(p.limitTimesEfficiency->value)
           + " V/m; choose Gamma, then kappa_c is this over Gamma\n";
}

std::string sizeName(const sizePrediction& p)
{
    return "radius " + shown(p.radius) + " m";
}

std::string sizeLawText(const sizeLawResult& result)
{
    std::string text = "Size law (R19) through " + std::to_string(result.sizes)
                       + " sizes: Gamma = " + shown(result.law.planeField, 5) + " V/m + "
                       + shown(result.law.surfacePotential, 5) + " V / r\n";
    for (const sizePrediction& p : result.predictions) {
        text += "\n    " + sizeName(p)
                + (p.efficiency ? ", kappa_c as the mean of the sizes\n" : ", kappa_c not known of every size\n")
                + table(quantitiesOf(p));
    }
    return text;
}

void addCsv(std::ostringstream& csv, const std::string& from, const std::string& branch,
            const std::vector<quantity>& quantities)
{
    for (const quantity& q : quantities) {
        csv << from << ',' << branch << ',' << q.name << ',' << q.unit;
        for (const double x :
             {q.estimate.value, q.estimate.lower95, q.estimate.upper95, q.estimate.minimum, q.estimate.maximum}) {
            csv << ',' << x;
        }
        csv << '\n';
    }
}

}  // namespace

std::string logText(const parameterReport& report)
{
    std::string text;
    for (std::size_t n = 0; n < report.measurements.size(); ++n) {
        const namedMeasurement& m = report.measurements[n];
        const ChargingParameters& p = report.parameters[n];
        text += m.name + "\n    R Fig. 3: " + questions(m.measured) + ": branch " + nameOf(p.branch) + "\n    "
                + equationsOf(p.branch) + "\n    contact area: " + areaSource(m.measured) + "\n"
                + table(quantitiesOf(p)) + "\n";
    }
    if (report.sizeLaw) {
        text += sizeLawText(*report.sizeLaw) + "\n";
    }
    return text;
}

std::string csvText(const parameterReport& report)
{
    std::ostringstream csv;
    csv.precision(10);
    csv << "from,branch,quantity,unit,average,lower95,upper95,minimum,maximum\n";
    for (std::size_t n = 0; n < report.measurements.size(); ++n) {
        addCsv(csv, report.measurements[n].name, nameOf(report.parameters[n].branch),
               quantitiesOf(report.parameters[n]));
    }
    if (report.sizeLaw) {
        const SizeLaw& law = report.sizeLaw->law;
        const auto exact = [](double x) { return Estimate{x, x, x, x, x}; };
        addCsv(
            csv, "sizeLaw", "R19",
            {{"plane field", "V/m", exact(law.planeField)}, {"surface potential", "V", exact(law.surfacePotential)}});
        for (const sizePrediction& p : report.sizeLaw->predictions) {
            addCsv(csv, sizeName(p), "R19", quantitiesOf(p));
        }
    }
    return csv.str();
}

std::string entriesText(const parameterReport& report)
{
    std::string text = "# For fix ID all charge/gran/contact: put the words of the lines without # on its line.\n";
    const bool frozen = std::any_of(report.parameters.begin(), report.parameters.end(), needsFrozen);
    if (frozen) {
        text += "# R23 knows its kappa_c for charges that are frozen within a contact only, so all lines are for that form:\n"
                "update frozen\n";
    }
    for (std::size_t n = 0; n < report.measurements.size(); ++n) {
        text += entryOf(report.measurements[n], report.parameters[n], frozen);
    }
    if (report.sizeLaw) {
        if (frozen) {
            text += "# The kappa_c of these sizes are for 'update updated', not for 'update frozen':\n";
        }
        for (const sizePrediction& p : report.sizeLaw->predictions) {
            text += p.efficiency
                        ? withBands(sizeName(p), 1, 2, p.transferLimit, *p.efficiency)
                        : "# " + sizeName(p) + ": Gamma " + shown(p.transferLimit.value) + " V/m, kappa_c unknown\n";
        }
    }
    return text;
}

}  // namespace him
