// SPDX-License-Identifier: GPL-3.0-or-later
#include "chargingParameters/measurementEntries.H"

#include <cmath>

namespace him {

namespace {

const std::vector<std::string> contactNames = {"particleWall", "dissimilarPair", "similarPair"};

Measured asMeasured(const ValueWithEnds& read)
{
    return {read.value, read.lower, read.upper};
}

std::optional<Measured> optionalEntry(checkedDictionary& dictionary, const std::string& entry)
{
    const std::optional<ValueWithEnds> read = dictionary.valueWithEnds(entry, false);
    return read ? std::optional<Measured>(asMeasured(*read)) : std::nullopt;
}

double poissonsRatio(checkedDictionary& dictionary)
{
    const double ratio = dictionary.number("poissonsRatio");
    if (!(ratio > -1 && ratio <= 0.5)) {
        dictionary.complain("poissonsRatio",
                            "found " + shown(ratio) + ", but a number above -1 and at most 0.5 is expected.");
        return 0;
    }
    return ratio;
}

Elasticity elasticity(checkedDictionary& dictionary)
{
    const double modulus = dictionary.positive("youngsModulus");
    return {modulus, poissonsRatio(dictionary)};
}

/// What the area of an impact needs to know of a sphere; only asked for where the area comes from a speed.
void readMechanics(checkedDictionary& dictionary, bool needed, MeasuredBody& body)
{
    if (needed || dictionary.has("density")) {
        body.density = dictionary.positive("density");
    }
    if (needed || dictionary.has("youngsModulus") || dictionary.has("poissonsRatio")) {
        body.elasticity = elasticity(dictionary);
    }
}

void readSaturation(checkedDictionary& dictionary, MeasuredBody& body)
{
    body.saturationCharge = optionalEntry(dictionary, "saturationCharge");
    body.transferLimit = optionalEntry(dictionary, "transferLimit");
    if (body.saturationCharge && body.transferLimit) {
        dictionary.complain("transferLimit",
                            "saturationCharge is there as well. One follows from the other (R17): give one of "
                            "them.");
        body.transferLimit.reset();
    }
}

MeasuredBody readBody(checkedDictionary dictionary, bool fromImpact)
{
    MeasuredBody body;
    if (!dictionary.readable()) {
        body.radius = Measured::exact(1);
        return body;
    }
    body.radius = measuredEntry(dictionary, "radius", 1);
    body.initialCharge = optionalEntry(dictionary, "initialCharge").value_or(Measured::exact(0));
    readMechanics(dictionary, fromImpact, body);
    readSaturation(dictionary, body);
    dictionary.refuseUnknownEntries();
    return body;
}

/// The partner of a similar pair: the particle once more, with a charge of its own.
MeasuredBody readTwin(checkedDictionary dictionary)
{
    MeasuredBody body;
    body.initialCharge = optionalEntry(dictionary, "initialCharge").value_or(Measured::exact(0));
    dictionary.refuseUnknownEntries();
    return body;
}

void readArea(checkedDictionary& dictionary, Measurement& m)
{
    m.areaLaw =
        dictionary.oneOf("areaLaw", {"hertz", "doubled"}, "hertz") == "hertz" ? AreaLaw::hertz : AreaLaw::doubled;
    m.area = optionalEntry(dictionary, "contactArea");
    m.normalSpeed = optionalEntry(dictionary, "normalSpeed");
    if (m.area && m.normalSpeed) {
        dictionary.complain("normalSpeed",
                            "contactArea is there as well. Give the area of a DEM run or the speed of the impact, "
                            "not both.");
        m.normalSpeed.reset();
    }
    if (m.atWall && dictionary.has("wall")) {
        checkedDictionary wall = dictionary.section("wall", true);
        if (!m.normalSpeed) {
            dictionary.complain(
                "wall", "elastic constants of the wall are for the area of an impact, but there is no normalSpeed.");
        }
        if (wall.readable()) {
            m.wall = elasticity(wall);
            wall.refuseUnknownEntries();
        }
    }
}

void readReadings(checkedDictionary& dictionary, Measurement& m)
{
    if (!m.atWall) {
        return;
    }
    for (const auto& [contacts, charge] : dictionary.pairs("readings")) {
        m.historyContacts.push_back(contacts);
        m.historyCharges.push_back(charge);
    }
    if (m.historyContacts.empty()) {
        return;
    }
    if (m.chargeTransfer || m.particle.saturationCharge || m.particle.transferLimit) {
        dictionary.complain("readings",
                            "the readings hold the saturation charge and kappa_c. Leave out chargeTransfer, "
                            "saturationCharge and transferLimit, or the readings.");
    }
    for (std::size_t k = 1; k < m.historyContacts.size(); ++k) {
        if (!(m.historyContacts[k] > m.historyContacts[k - 1])) {
            dictionary.complain("readings", "the number of contacts must grow from reading to reading, found "
                                                + shown(m.historyContacts[k]) + " after "
                                                + shown(m.historyContacts[k - 1]) + ".");
            return;
        }
    }
}

void readTypes(checkedDictionary& dictionary, namedMeasurement& result)
{
    result.typeJ = result.measured.similar ? 1 : 2;
    const std::vector<double> types = dictionary.numbers("types");
    if (types.empty()) {
        return;
    }
    const auto isType = [](double type) { return type >= 1 && type == std::floor(type); };
    if (types.size() != 2 || !isType(types[0]) || !isType(types[1])) {
        dictionary.complain("types", "two LIGGGHTS atom types are expected, like (1 2).");
        return;
    }
    result.typeI = static_cast<long>(types[0]);
    result.typeJ = static_cast<long>(types[1]);
}

namedMeasurement readMeasurement(checkedDictionary dictionary, const std::string& name)
{
    namedMeasurement result;
    result.name = name;
    Measurement& m = result.measured;
    const std::string contact = dictionary.oneOf("contact", contactNames);
    m.atWall = contact != "dissimilarPair" && contact != "similarPair";
    m.similar = contact == "similarPair";
    readArea(dictionary, m);
    m.particle = readBody(dictionary.section("particle"), m.normalSpeed.has_value());
    if (m.similar) {
        m.partner = readTwin(dictionary.section("partner", true));
    } else if (!m.atWall) {
        m.partner = readBody(dictionary.section("partner"), m.normalSpeed.has_value());
    }
    m.chargeTransfer = optionalEntry(dictionary, "chargeTransfer");
    readReadings(dictionary, m);
    readTypes(dictionary, result);
    dictionary.refuseUnknownEntries();
    return result;
}

}  // namespace

Measured measuredEntry(checkedDictionary& dictionary, const std::string& entry, double harmless)
{
    const std::optional<ValueWithEnds> read = dictionary.valueWithEnds(entry, true);
    return read ? asMeasured(*read) : Measured::exact(harmless);
}

std::vector<namedMeasurement> readMeasurements(checkedDictionary& dictionary, Complaints& complaints)
{
    std::vector<namedMeasurement> all;
    if (!dictionary.has("measurements")) {
        return all;
    }
    checkedDictionary section = dictionary.section("measurements");
    for (const std::string& name : section.sections()) {
        const std::size_t before = complaints.lines().size();
        all.push_back(readMeasurement(section.section(name), name));
        if (complaints.lines().size() > before) {
            continue;  // what is impossible can not be told from what is missing
        }
        for (const std::string& fault : faultsOf(all.back().measured)) {
            section.complain(name, fault + ".");
        }
    }
    if (section.readable() && all.empty()) {
        dictionary.complain("measurements", "there is no measurement in it. Add a sub-dictionary per experiment.");
    }
    section.refuseUnknownEntries();
    return all;
}

}  // namespace him
