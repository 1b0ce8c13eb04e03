// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/runReport.H"

#include "insulatingWalls/wallCharges.H"
#include "settings/checkedDictionary.H"

#include "dem_coupling/accuracy_choice.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace him {

namespace {

struct wallRow {
    std::string wall, shape, target, kind, model, charging;
};

/// "grounded conductor", "conductor at 5 V", "conductor at -5 to 5 V". Collective.
std::string kindOf(const Foam::fvPatchScalarField& voltage)
{
    const double lowest = Foam::gMin(voltage);
    const double highest = Foam::gMax(voltage);
    if (lowest == 0 && highest == 0) {
        return "grounded conductor";
    }
    return "conductor at " + shown(lowest) + (highest > lowest ? " to " + shown(highest) : "") + " V";
}

wallRow rowOf(const DemWall& wall, const std::string& target, const DemPort& dem, const foamPoissonMesh* mesh)
{
    wallRow row{wall.name, wall.shape, target, "", wall.chargingModel ? "charge" : "no charge", "yes"};
    if (target == noTransfer) {
        row.target = "-";
        row.kind = "no transfer";
    } else if (!mesh) {
        row.kind = "grounded conductor";
    } else if (wallCharges::isInsulating(target, mesh->matter())) {
        row.kind = "insulating, keeps charge";
    } else {
        const Foam::label patch = mesh->mesh().boundaryMesh().findPatchID(target);
        row.kind = kindOf(mesh->electricPotential().boundaryField()[patch]);
    }
    if (target == noTransfer || !wall.chargingModel || !dem.charging()) {
        row.charging = "no";
    }
    return row;
}

std::string wallTable(const caseSettings& settings, const DemPort& dem, const foamPoissonMesh* mesh)
{
    std::ostringstream table;
    const auto line = [&table](const wallRow& row) {
        table << "    " << std::left << std::setw(16) << row.wall << std::setw(12) << row.shape << std::setw(16)
              << row.target << std::setw(28) << row.kind << std::setw(12) << row.model << row.charging << '\n';
    };
    line({"wall", "shape", "patch", "kind", "model", "charging"});
    for (const DemWall& wall : dem.walls()) {
        const auto entry = std::find_if(settings.walls.begin(), settings.walls.end(),
                                        [&](const auto& mapped) { return mapped.first == wall.name; });
        line(rowOf(wall, entry->second, dem, mesh));
    }
    return table.str();
}

/// "clouds of 3 cells, quartic gather, deferred correction"
std::string cloudText(const P3mSettings& p3m)
{
    std::ostringstream text;
    text << "clouds of " << (p3m.cloudRadius > 0 ? p3m.cloudRadius : p3m.cloudCells)
         << (p3m.cloudRadius > 0 ? " m, " : " cells, ")
         << (p3m.gather == PolynomialOrder::quartic ? "quartic" : "cubic") << " gather"
         << (p3m.deferredCorrection ? ", deferred correction" : "")
         << (p3m.nearPrecision == NearPrecision::singlePrecision ? ", pairs in single precision" : "");
    return text.str();
}

/// How much of the walls' response to a particle's own charge charging sees in spite of `wallContactField total`; empty where
/// it sees none, and for p3m, which knows when it has seen the particles (printOwnResponse).
std::string ownResponseText(const FieldSettings& field)
{
    if (field.method == "him" && field.him.ownCellResponse == OwnCellResponse::keep) {
        return "him keeps it, so isolated particles stop short of q_sat. `ownCellResponse forceOnly;` in himCoeffs "
               "hides it from charging";
    }
    if (field.method == "himCell" || field.method == "hybridParticleCell") {
        return field.method
               + " keeps it, so isolated particles stop short of q_sat. Take p3m, or him with ownCellResponse "
                 "forceOnly";
    }
    return {};
}

/// What is to be expected of the settings in view of the accuracy that was asked for.
std::string accuracyText(const FieldSettings& field)
{
    const double expected = expectedError(field);
    std::ostringstream text;
    text << "Accuracy " << field.accuracy << " asked for (relative RMS field error): ";
    if (std::isnan(expected)) {
        text << "WARNING: nothing is known of the error of these settings. Leave out fieldMethod and the entries of "
                "p3mCoeffs to let accuracy choose.";
    } else if (field.method == "pairwiseSum") {
        text << "pairwiseSum " << (field.pairwiseSum.images ? "with images" : "without images") << ", "
             << (expected > 0               ? "expected at most " + shown(expected)
                 : field.pairwiseSum.images ? std::string("exact here")
                                            : std::string("exact where there is no conductor"))
             << '.';
        if (expected > field.accuracy) {
            text << " WARNING: fieldMethod wins over accuracy and gives less; leave it out.";
        }
    } else {
        text << "expected at most " << expected << " between plane walls without re-entrant edges, about "
             << std::max(expected, curvedWallError) << " between curved ones";
        if (field.cellsPerDiameter > 1) {
            text << ", in cells of 1/" << shown(field.cellsPerDiameter, 3) << " of a particle's diameter";
        }
        text << '.';
        if (expected > field.accuracy && field.accuracy < smallestAccuracy(field.cellsPerDiameter)) {
            text << " WARNING: no clouds are known to give as little in such cells; take cells of a diameter.";
        } else if (expected > field.accuracy) {
            text << " WARNING: the entries of p3mCoeffs win over accuracy and give less; leave them out.";
        }
    }
    return text.str();
}

}  // namespace

void printScene(const caseSettings& settings, const DemPort& dem, const foamPoissonMesh* mesh, double deltaT,
                long demSteps)
{
    using Foam::Info;
    const FieldSettings& field = settings.field;
    if (!settings.electrostatics) {
        Info << "\nNo electrostatics.\n\nClocks: gas step " << deltaT << " s = " << Foam::label(demSteps)
             << " DEM steps of " << dem.timeStep() << " s\n"
             << Foam::endl;
        return;
    }
    const std::string equilibria = describe(dem.equilibria());
    Info << "\nWalls\n"
         << wallTable(settings, dem, mesh).c_str() << "\nContact charging\n"
         << dem.chargingDescription().c_str() << "\n    field at wall contacts: "
         << (settings.wallContactField == WallContactField::total ? "total" : "self");
    const std::string own = ownResponseText(field);
    if (dem.charging() && !settings.fixedUniformCharge && settings.wallContactField == WallContactField::total
        && !own.empty()) {
        Info << "\n    response of walls to a particle's own charge: " << own.c_str();
    }
    if (!equilibria.empty()) {
        Info << "\n\nEquilibrium at uncharged walls (S2.14), e/g by S2.15, of particles of mean diameter\n"
             << equilibria.c_str();
    }
    Info << "\n\nField method " << field.method.c_str();
    if (FieldMethod::needsCutoff(field.method)) {
        Info << ", nearCutoff " << field.nearCutoff << " m";
    }
    if (field.method == "p3m") {
        Info << ", " << cloudText(field.p3m).c_str();
    }
    if (mesh) {
        Info << ", largest cell diagonal " << mesh->largestCellDiagonal() << " m";
    }
    const Vector3& e = field.externalField;
    Info << ", permittivity " << field.permittivity << " F/m, external field (" << e.x() << ' ' << e.y() << ' ' << e.z()
         << ") V/m\n\nClocks: field update every " << deltaT << " s = " << Foam::label(demSteps) << " DEM steps of "
         << dem.timeStep() << " s\n";
    if (field.nearField.interval > 0) {
        Info << "    near field anew every " << Foam::label(field.nearField.interval) << " DEM steps, within "
             << field.nearField.reach << " m\n";
    }
    if (field.accuracy > 0) {
        Info << accuracyText(field).c_str() << '\n';
    }
    if (dem.ranBeforeHandOver()) {
        Info << "The DEM script ran steps of its own before the hand-over: with field and charging off.\n";
    }
    Info << Foam::endl;
}

void printUniformCharge(const UniformCharge& charge)
{
    Foam::Info << "Fixed uniform charge: charging is off, walls keep what they have. ";
    if (charge.replaced) {
        Foam::Info << "All " << Foam::label(charge.particles) << " particles got their mean, "
                   << shown(charge.mean, 12).c_str() << " C; in all " << shown(charge.before, 12).c_str()
                   << " C before, " << shown(charge.after, 12).c_str() << " C now";
    } else {
        Foam::Info << "All " << Foam::label(charge.particles) << " particles had the same charge already, "
                   << shown(charge.mean, 12).c_str() << " C";
    }
    Foam::Info << '\n' << Foam::endl;
}

void printOwnResponse(const FieldMethod& method)
{
    const std::string text = method.ownResponseText();
    if (!text.empty()) {
        Foam::Info << "Response of walls to a particle's own charge: " << text.c_str() << '.' << Foam::endl;
    }
}

void printOwnCellField(FieldMethod& method, const DemParticles& particles)
{
    const std::optional<OwnCellField> own = method.ownCellField(particles);
    if (!own) {
        return;
    }
    constexpr double warnAbove = 0.05;
    Foam::Info << "Self-field of particles in their own cells, away from walls: ";
    if (own->tag == 0) {
        Foam::Info << "none, the cells are uniform" << Foam::endl;
        return;
    }
    Foam::Info << "up to " << shown(own->share, 3).c_str() << " of the field at the surface (particle " << own->tag
               << ", a sample of the most uneven cells)" << Foam::endl;
    if (own->share > warnAbove) {
        Foam::Info
            << "WARNING: him makes a field of a particle's own charge, because cells grow from one to the next. Write "
               "ownCellResponse remove; in himCoeffs, use uniform cells, or fieldMethod p3m."
            << Foam::endl;
    }
}

}  // namespace him
