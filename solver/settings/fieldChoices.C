// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/fieldChoices.H"

#include "settings/checkedDictionary.H"

#include "dem_coupling/accuracy_choice.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>

namespace him {

namespace {

void readPairwiseSum(checkedDictionary& coeffs, PairwiseSumSettings& settings)
{
    settings.images = coeffs.yesNo("images", settings.images);
    settings.truncation = coeffs.positive("truncation", settings.truncation);
}

void readP3m(checkedDictionary& coeffs, P3mSettings& settings)
{
    const bool inMetres = coeffs.has("cloudRadius");
    settings.cloudRadius = inMetres ? coeffs.positive("cloudRadius", 1) : 0;
    settings.cloudCells = coeffs.positive("cloudCells", settings.cloudCells);
    settings.cloudExponent = static_cast<int>(coeffs.nonNegativeInteger("cloudExponent", settings.cloudExponent));
    const char* gather = settings.gather == PolynomialOrder::quartic ? "quartic" : "cubic";
    settings.gather = coeffs.oneOf("gather", {"cubic", "quartic"}, gather) == "quartic" ? PolynomialOrder::quartic
                                                                                        : PolynomialOrder::cubic;
    settings.deferredCorrection = coeffs.yesNo("deferredCorrection", settings.deferredCorrection);
    settings.selfTerm = coeffs.yesNo("selfTerm", settings.selfTerm);
    const char* precision = settings.nearPrecision == NearPrecision::singlePrecision ? "single" : "double";
    settings.nearPrecision = coeffs.oneOf("nearPrecision", {"single", "double"}, precision) == "single"
                                 ? NearPrecision::singlePrecision
                                 : NearPrecision::doublePrecision;
}

/// The accuracy asked for, or 0.
double readAccuracy(checkedDictionary& properties)
{
    if (!properties.has("accuracy")) {
        return 0;
    }
    const double accuracy = properties.positive("accuracy", 1);
    if (accuracy < smallestAccuracy()) {
        properties.complain("accuracy", "found " + shown(accuracy)
                                            + ", the smallest relative RMS field error that a method "
                                              "is known to reach is "
                                            + shown(smallestAccuracy())
                                            + ". Ask for that much, or give fieldMethod and its entries.");
        return 0;
    }
    return accuracy;
}

FieldErrorSettings readFieldError(checkedDictionary& properties)
{
    FieldErrorSettings settings;
    checkedDictionary entries = properties.section("fieldError", true);
    settings.active = entries.yesNo("active", settings.active);
    settings.interval = entries.nonNegativeInteger("interval", settings.interval);
    settings.sample = entries.positiveInteger("sample", settings.sample);
    entries.refuseUnknownEntries();
    return settings;
}

/// Entries of settings.method in its sub-dictionary, which may be absent.
void readCoeffs(checkedDictionary& coeffs, FieldSettings& settings)
{
    const std::string& method = settings.method;
    if (FieldMethod::needsCutoff(method)) {
        const double cutoff = coeffs.positive("nearCutoff");
        settings.nearCutoff = coeffs.readable() ? cutoff : 0;
    }
    if (method == "pairwiseSum") {
        readPairwiseSum(coeffs, settings.pairwiseSum);
    } else if (method == "him") {
        const std::string own = coeffs.oneOf("ownCellResponse", {"keep", "forceOnly", "remove"}, "keep");
        settings.him.ownCellResponse = own == "remove"      ? OwnCellResponse::remove
                                       : own == "forceOnly" ? OwnCellResponse::forceOnly
                                                            : OwnCellResponse::keep;
    } else if (method == "himCell") {
        settings.himCell.deltaMin = coeffs.has("deltaMin") ? coeffs.positive("deltaMin", 1) : 0;
    } else if (method == "p3m") {
        readP3m(coeffs, settings.p3m);
    }
}

}  // namespace

const fieldChoice* fieldChoices::find(const std::string& name) const
{
    const auto found = std::find_if(all.begin(), all.end(), [&](const fieldChoice& c) { return c.name == name; });
    return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> fieldChoices::names() const
{
    std::vector<std::string> list;
    std::transform(all.begin(), all.end(), std::back_inserter(list), [](const fieldChoice& c) { return c.name; });
    return list;
}

fieldChoices readFieldChoices(const Foam::fileName& casePath, Complaints& complaints)
{
    checkedDictionary properties(casePath, "constant/electrostaticProperties", complaints);
    const bool byAccuracy = properties.has("accuracy");
    const double accuracy = readAccuracy(properties);
    const std::string selected = properties.oneOf("fieldMethod", FieldMethod::names(), byAccuracy ? "p3m" : "");
    FieldSettings common;
    common.externalField = properties.vector("externalField", Vector3::Zero());
    const double gas = properties.positive("relativePermittivity", 1);
    common.permittivity = epsilon0 * gas;

    common.neutralisingBackground = properties.yesNo("neutralisingBackground", false);

    checkedDictionary nearField = properties.section("nearField", true);
    if (properties.has("nearField")) {
        common.nearField.interval = nearField.positiveInteger("interval", 1);
        common.nearField.reach = nearField.positive("reach");
        nearField.refuseUnknownEntries();
    }

    fieldChoices choices;
    choices.selected = common;
    choices.methodByAccuracy = accuracy > 0 && !properties.has("fieldMethod");
    choices.fieldError = readFieldError(properties);
    choices.dielectrics = readDielectricChoices(properties, gas);
    for (const std::string& method : FieldMethod::names()) {
        fieldChoice choice{method, common};
        choice.settings.method = method;
        if (accuracy > 0 && method == selected) {
            choice.settings.accuracy = accuracy;
            choice.settings.p3m = chooseForAccuracy(accuracy).p3m;  // entries of the case win
        }
        const bool required = method == selected && FieldMethod::needsCutoff(method);
        checkedDictionary coeffs = properties.section(method + "Coeffs", !required);
        readCoeffs(coeffs, choice.settings);
        coeffs.refuseUnknownEntries();
        if (accuracy > 0 && method == selected && method == "p3m") {
            choices.cloudsByAccuracy = !coeffs.has("cloudCells") && !coeffs.has("cloudRadius") && !coeffs.has("gather")
                                       && !coeffs.has("deferredCorrection");
        }
        if (method == selected) {
            choices.selected = choice.settings;
        }
        choices.all.push_back(choice);
    }
    for (const std::string& name : properties.sectionsWith("fieldMethod")) {
        fieldChoice choice{name, common};
        checkedDictionary coeffs = properties.section(name);
        choice.settings.method = coeffs.oneOf("fieldMethod", FieldMethod::names());
        if (choice.settings.method.empty()) {
            continue;
        }
        readCoeffs(coeffs, choice.settings);
        coeffs.refuseUnknownEntries();
        if (choices.find(name)) {
            coeffs.complain("fieldMethod", "`" + name + "` is the name of a method. Give the variant another name.");
            continue;
        }
        choices.all.push_back(choice);
    }
    properties.refuseUnknownEntries();
    return choices;
}

}  // namespace him
