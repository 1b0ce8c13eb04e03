// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/caseSettings.H"

#include "settings/checkedDictionary.H"

#include "electrostatics/constants.hpp"

#include "OSspecific.H"
#include "Pstream.H"

#include <algorithm>

namespace him {

namespace {

/// Whether the master rank sees this file or folder. Collective.
bool existsInCase(const Foam::fileName& path)
{
    bool found = Foam::Pstream::master() && Foam::exists(path);
    Foam::Pstream::scatter(found);
    return found;
}

FieldSettings readFieldSettings(const Foam::fileName& casePath, Complaints& complaints)
{
    checkedDictionary properties(casePath, "constant/electrostaticProperties", complaints);
    FieldSettings settings;
    settings.method = properties.oneOf("fieldMethod", FieldMethod::names());
    settings.externalField = properties.vector("externalField", Vector3::Zero());
    settings.permittivity = epsilon0 * properties.positive("relativePermittivity", 1);
    for (const std::string& method : FieldMethod::names()) {
        if (FieldMethod::needsCutoff(method)) {
            const bool selected = method == settings.method;
            checkedDictionary coeffs = properties.section(method + "Coeffs", !selected);
            const double cutoff = coeffs.positive("nearCutoff");
            settings.nearCutoff = selected && coeffs.readable() ? cutoff : settings.nearCutoff;
            coeffs.refuseUnknownEntries();
        }
    }
    properties.refuseUnknownEntries();
    return settings;
}

}  // namespace

caseSettings readCaseSettings(const Foam::fileName& casePath, Complaints& complaints)
{
    caseSettings settings;
    settings.field = readFieldSettings(casePath, complaints);
    settings.needsMesh = settings.field.method.empty() ? existsInCase(casePath / "constant" / "polyMesh")
                                                       : FieldMethod::needsMesh(settings.field.method);

    checkedDictionary properties(casePath, "constant/couplingProperties", complaints);
    const std::string script = properties.text("demScript");
    settings.demScript = casePath / script;
    if (!script.empty() && !existsInCase(settings.demScript)) {
        properties.complain("demScript", "there is no file " + settings.demScript
                                             + ". Give the path of the LIGGGHTS script "
                                               "relative to the case.");
    }
    settings.walls = properties.section("walls").words();
    settings.wallContactField = properties.oneOf("wallContactField", {"total", "self"}, "total") == "self"
                                    ? WallContactField::self
                                    : WallContactField::total;
    settings.field.outsideMesh = properties.oneOf("particlesOutsideMesh", {"error", "excluded"}, "error") == "excluded"
                                     ? OutsideMesh::excluded
                                     : OutsideMesh::error;
    settings.allowRemovals = properties.yesNo("allowRemovals", false);
    settings.demCheckpoint = properties.yesNo("demCheckpoint", true);
    settings.logInterval = properties.positiveInteger("logInterval", 1);
    settings.chargeInterval = properties.positiveInteger("chargeInterval", 1);
    properties.refuseUnknownEntries();
    return settings;
}

}  // namespace him
