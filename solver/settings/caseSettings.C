// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/caseSettings.H"

#include "settings/checkedDictionary.H"
#include "settings/electricRegion.H"
#include "settings/fieldChoices.H"

#include "OSspecific.H"
#include "Pstream.H"

namespace him {

namespace {

/// Whether the master rank sees this file or folder. Collective.
bool existsInCase(const Foam::fileName& path)
{
    bool found = Foam::Pstream::master() && Foam::exists(path);
    Foam::Pstream::scatter(found);
    return found;
}

ProjectiveSettings readProjectiveCharging(checkedDictionary& properties, bool fixedCharge)
{
    ProjectiveSettings settings;
    if (!properties.has("projectiveCharging")) {
        return settings;
    }
    checkedDictionary entries = properties.section("projectiveCharging");
    settings.active = entries.readable();
    for (const auto& [entry, value] : {std::pair<const char*, long*>{"burst", &settings.burst}, {"leap", &settings.leap}}) {
        if (entries.readable() && !entries.has(entry)) {
            entries.complain(entry, "the entry is missing. Write { burst <field updates>; leap <bursts>; }.");
        }
        *value = entries.positiveInteger(entry, 1);
    }
    entries.refuseUnknownEntries();
    if (fixedCharge) {
        properties.complain("projectiveCharging", "fixedUniformCharge switches charging off, so there is nothing to project. Take one of "
                                                  "them out.");
    }
    return settings;
}

}  // namespace

caseSettings readCaseSettings(const Foam::fileName& casePath, Complaints& complaints)
{
    caseSettings settings;
    if (hasGas(casePath)) {
        settings.gas = readGasProperties(casePath, complaints);
        settings.electrostatics = checkedDictionary::exists(casePath, "constant/electrostaticProperties");
    }
    if (settings.electrostatics) {
        const fieldChoices choices = readFieldChoices(casePath, complaints);
        settings.field = choices.selected;
        settings.fieldError = choices.fieldError;
        settings.dielectrics = choices.dielectrics;
        settings.methodByAccuracy = choices.methodByAccuracy;
        settings.cloudsByAccuracy = choices.cloudsByAccuracy;
        if (settings.methodByAccuracy && !hasElectricMesh(casePath)) {
            settings.field.method = "pairwiseSum";
            settings.field.pairwiseSum.images = true;
        }
        settings.needsMesh =
            settings.field.method.empty() ? hasElectricMesh(casePath) : FieldMethod::needsMesh(settings.field.method);
    } else {
        settings.fieldError.active = false;
    }

    checkedDictionary properties(casePath, "constant/couplingProperties", complaints);
    const std::string script = properties.text("demScript");
    settings.demScript = casePath / script;
    if (!script.empty() && !existsInCase(settings.demScript)) {
        properties.complain("demScript", "there is no file " + settings.demScript
                                             + ". Give the path of the LIGGGHTS script "
                                               "relative to the case.");
    }
    settings.walls = properties.section("walls", !settings.electrostatics).words();
    settings.wallContactField = properties.oneOf("wallContactField", {"total", "self"}, "total") == "self"
                                    ? WallContactField::self
                                    : WallContactField::total;
    settings.field.outsideMesh = properties.oneOf("particlesOutsideMesh", {"error", "excluded"}, "error") == "excluded"
                                     ? OutsideMesh::excluded
                                     : OutsideMesh::error;
    settings.wallDistance = properties.has("wallDistance") ? properties.positive("wallDistance", 1) : 0;
    if (settings.gas) {
        settings.gas->exchange.particlesOutsideAllowed = settings.field.outsideMesh == OutsideMesh::excluded;
    }
    settings.allowRemovals = properties.yesNo("allowRemovals", false);
    settings.fixedUniformCharge = properties.yesNo("fixedUniformCharge", false);
    settings.projectiveCharging = readProjectiveCharging(properties, settings.fixedUniformCharge);
    settings.demCheckpoint = properties.yesNo("demCheckpoint", true);
    settings.logInterval = properties.positiveInteger("logInterval", 1);
    settings.chargeInterval = properties.positiveInteger("chargeInterval", 1);
    properties.refuseUnknownEntries();
    settings.statistics = readStatisticsChoices(casePath, complaints);
    return settings;
}

}  // namespace him
