// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/gasChecks.H"

#include "checks/caseChecks.H"
#include "electrostatics/constants.hpp"
#include "gas/gasNumericsChecks.H"
#include "gas/gasTurbulence.H"
#include "settings/checkedDictionary.H"
#include "settings/foamExceptions.H"

#include "OSspecific.H"
#include "coupledPolyPatch.H"
#include "cyclicPolyPatch.H"
#include "directionMixedFvPatchFields.H"
#include "emptyPolyPatch.H"
#include "fixedFluxPressureFvPatchScalarField.H"
#include "fvc.H"
#include "mixedFvPatchFields.H"
#include "processorCyclicPolyPatch.H"
#include "transformFvPatchFields.H"
#include "volFields.H"
#include "wedgePolyPatch.H"

#include <array>
#include <cmath>

namespace him {

namespace {

bool onAllRanks(bool holds)
{
    return Foam::returnReduce(holds, Foam::andOp<bool>());
}

/// The field of that name at the start time, or nothing and a complaint. Collective.
template <class Field>
Foam::autoPtr<Field> readField(const Foam::word& name, const Foam::fvMesh& mesh, const Foam::dimensionSet& dimensions,
                               const std::string& units, const std::string& purpose, Complaints& complaints)
{
    const std::string where = mesh.time().timeName() + "/" + name;
    const Foam::IOobject header(name, mesh.time().timeName(), mesh, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE,
                                false);
    Foam::IOobject probe(header);
    if (!onAllRanks(probe.typeHeaderOk<Field>(true))) {
        complaints.add(where,
                       "there is no such field (" + Field::typeName + ") at the start time. It gives " + purpose + ".");
        return nullptr;
    }
    Foam::autoPtr<Field> field;
    attempt(where, complaints, [&] { field.reset(new Field(header, mesh)); });
    if (!onAllRanks(field.valid())) {
        return nullptr;
    }
    if (field().dimensions() != dimensions) {
        complaints.add(where + ": dimensions", "found other units. Write dimensions " + units + ";");
    }
    return field;
}

/// A particle's diameter over the cube root of the smallest cell, unless largestParticle says otherwise. A 15th of a sphere
/// of two cells fills .28 of one.
constexpr double largestAtCentre = 1;
constexpr double largestDivided = 2;

/// A sphere may fill this share of the cell that it is in when it is smoothed: its neighbours come on top.
constexpr double mostOfACell = 0.5;

/// Share of a cubic cell that a sphere fills which is laid into it and spread by 1 - L^2/4 laplacian: the answer of the cells of a
/// lattice to a point, by its expansion for a long length (3 % at L = 1.3 h, better beyond) and by the neighbours' first
/// for a short one.
/// @param diameter, length  over the edge of the cell
double smoothedShare(double diameter, double length)
{
    const double k = 2 / length;
    const double kept = k < 1.5 ? 0.2527 * k * k - k * k * k / (4 * pi) : k * k / (k * k + 6);
    return pi / 6 * diameter * diameter * diameter * kept;
}

/// A cyclic patch lies across an axis when its normals do to this share; periods are the same when they differ by less than this one.
constexpr double alongAxis = 0.9;
constexpr double samePeriod = 1e-6;

/// The DEM's weight and the gas's buoyancy must be of one gravity.
void checkGravity(const gasProperties& gas, const DemPort& dem, Complaints& complaints)
{
    const Vector3 script = dem.gravity();
    const Vector3 given = gas.exchange.gravity;
    if ((script - given).norm() > 1e-3 * std::max(script.norm(), given.norm())) {
        const auto words = [](const Vector3& g) {
            return "(" + shown(g[0]) + " " + shown(g[1]) + " " + shown(g[2]) + ")";
        };
        complaints.add(std::string(gasFile) + ": gravity",
                       "found " + words(given) + ", but the DEM script has " + words(script)
                           + " m/s2 (fix gravity; its variables are not read). Write the same in both.");
    }
}

/// What conditions of U and p find missing, a void fraction of another name or a density.
template <class Field> void checkConditions(Field& field, Complaints& complaints)
{
    for (auto& patch : field.boundaryFieldRef()) {
        // fixedFluxPressure is told its gradient by the flow.
        if (!Foam::isA<Foam::fixedFluxPressureFvPatchScalarField>(patch)) {
            attempt(field.time().timeName() + "/" + field.name() + ": " + patch.patch().name(), complaints,
                    [&] { patch.updateCoeffs(); });
        }
    }
}

/// Where the DEM is periodic the gas must be, with the same period. A DEM that is not lets its particles leave a periodic gas. Collective.
void checkPeriodicity(const Foam::fvMesh& mesh, const DemPort& dem, Complaints& complaints)
{
    std::array<bool, 3> cyclic{};
    for (const Foam::fvPatch& patch : mesh.boundary()) {
        const bool periodic =
            Foam::isA<Foam::cyclicPolyPatch>(patch.patch()) || Foam::isA<Foam::processorCyclicPolyPatch>(patch.patch());
        const Foam::vectorField normals(periodic ? patch.nf()() : Foam::vectorField());
        for (const Foam::vector& normal : normals) {
            for (int axis = 0; axis < 3; ++axis) {
                cyclic[static_cast<std::size_t>(axis)] |= std::abs(normal[axis]) > alongAxis;
            }
        }
    }
    const Foam::boundBox bounds(mesh.points(), true);
    const Box box = dem.box();
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(axis);
        const bool gas = Foam::returnReduce(bool(cyclic[n]), Foam::orOp<bool>());
        const std::string direction(1, "xyz"[axis]);
        const double allowed = samePeriod * box.size()[axis];
        if (!dem.periodic()[n]) {
            continue;
        }
        if (!gas) {
            complaints.add("DEM script: boundary", "the DEM is periodic along " + direction
                                                       + ", but the gas has no cyclic patches there. Write f for this "
                                                         "direction, or give the gas's mesh cyclic patches.");
        } else if (std::abs(box.lower[axis] - bounds.min()[axis]) > allowed
                   || std::abs(box.upper[axis] - bounds.max()[axis]) > allowed) {
            complaints.add("DEM script: region", "both are periodic along " + direction + ", the DEM from "
                                                     + shown(box.lower[axis]) + " to " + shown(box.upper[axis])
                                                     + " m, the gas from " + shown(bounds.min()[axis]) + " to "
                                                     + shown(bounds.max()[axis]) + " m. Give both the same box.");
        }
    }
}

/// Fields and entries of the turbulence model, tried on a copy of the flow. Collective.
void checkTurbulence(const gasProperties& gas, const Foam::volScalarField& voidFraction, const Foam::volVectorField& U,
                     const Foam::surfaceScalarField& flux, Complaints& complaints)
{
    if (gas.turbulence.empty()) {
        return;
    }
    attempt(std::string(turbulenceFile) + ": " + gas.turbulence, complaints,
            [&] { gasTurbulence(voidFraction, U, flux, flux, gas.exchange.viscosity / gas.exchange.density); });
}

/// Inflow, wall and outlet must be told apart: velocity or pressure has to be given on every patch.
void checkPatches(const Foam::volVectorField& U, const Foam::volScalarField& p, Complaints& complaints)
{
    const std::string time = U.mesh().time().timeName();
    forAll(U.boundaryField(), index)
    {
        const Foam::fvPatchVectorField& velocity = U.boundaryField()[index];
        const Foam::fvPatchScalarField& pressure = p.boundaryField()[index];
        const Foam::polyPatch& patch = velocity.patch().patch();
        if (Foam::isA<Foam::emptyPolyPatch>(patch) || Foam::isA<Foam::wedgePolyPatch>(patch)) {
            complaints.add(
                "constant/polyMesh/boundary: " + patch.name(),
                "found a patch of type " + patch.type()
                    + ". Particles move in three dimensions. Use a mesh with all three; symmetry or cyclic patches "
                      "may stand in for the missing one.");
            continue;
        }
        if (Foam::polyPatch::constraintType(patch.type())) {
            continue;
        }
        const bool fluxPressure = Foam::isA<Foam::fixedFluxPressureFvPatchScalarField>(pressure);
        // inletOutlet and its like say that they fix a value, but give way where the gas leaves; what they say holds with a given pressure.
        const bool mixed = Foam::isA<Foam::mixedFvPatchVectorField>(velocity)
                           || Foam::isA<Foam::directionMixedFvPatchVectorField>(velocity);
        // slip, partialSlip and fixedNormalSlip give the velocity through the patch.
        const bool velocityGiven =
            !mixed && (velocity.fixesValue() || Foam::isA<Foam::transformFvPatchField<Foam::vector>>(velocity));
        const bool pressureGiven =
            pressure.fixesValue() && !(mixed && Foam::isA<Foam::mixedFvPatchScalarField>(pressure));
        if (velocityGiven && !fluxPressure && !pressure.fixesValue()) {
            complaints.add(time + "/p: " + patch.name(),
                           "found " + pressure.type()
                               + ", but the velocity is given there, and the pressure must follow "
                                 "from it. Write type fixedFluxPressure; value uniform 0;");
        } else if (velocityGiven && pressure.fixesValue() && velocity.type().compare(0, 8, "pressure") != 0) {
            complaints.add(time + "/p: " + patch.name(),
                           "found " + pressure.type() + ", but " + time + "/U gives the velocity there by "
                               + velocity.type()
                               + ": gas would pass as the pressure says and not with that velocity. Write type "
                                 "fixedFluxPressure; value uniform 0; or free the velocity (zeroGradient or "
                                 "pressureInletOutletVelocity in U).");
        } else if (!velocityGiven && !pressureGiven) {
            complaints.add(
                time + "/U: " + patch.name(),
                "found " + velocity.type() + " for the velocity and " + pressure.type()
                    + " for the pressure: neither is given, so nothing says how much gas passes. Give an inlet a "
                      "fixedValue in U (or interstitialInletVelocity with alpha voidFraction), an outlet one in p.");
        }
    }
}

}  // namespace

Foam::autoPtr<Foam::fvMesh> openGasMesh(const Foam::Time& runTime, Complaints& complaints)
{
    if (!cutForThisRun(runTime, complaints)) {
        return nullptr;
    }
    const std::string where = std::string("constant") / Foam::fileName(Foam::polyMesh::meshSubDir);
    bool complete = true;
    if (!onAllRanks(Foam::isFile(runTime.path() / where / "owner"))) {
        complaints.add(
            where, "there is no mesh in " + runTime.path() / where
                       + ", but the gas needs one. Make it with blockMesh, and cut it with decomposePar for a parallel "
                         "run with the same number of ranks.");
        complete = false;
    }
    for (const char* file : {"system/fvSchemes", "system/fvSolution"}) {
        if (!checkedDictionary::exists(runTime.globalPath(), file)) {
            complaints.add(
                file, "there is no such file in the case; the gas needs it. See solver/doc/gas.md for its entries.");
            complete = false;
        }
    }
    if (!complete) {
        return nullptr;
    }
    Foam::autoPtr<Foam::fvMesh> mesh;
    attempt(where + ", system/fvSchemes or system/fvSolution", complaints, [&] {
        mesh.reset(new Foam::fvMesh(
            Foam::IOobject(Foam::polyMesh::defaultRegion, runTime.timeName(), runTime, Foam::IOobject::MUST_READ)));
    });
    return onAllRanks(mesh.valid()) ? std::move(mesh) : nullptr;
}

void checkGasFields(const gasProperties& gas, const Foam::fvMesh& mesh, Complaints& complaints)
{
    if (gas.pimple.referenceCellHere(mesh) >= mesh.nCells()) {
        complaints.add("system/fvSolution: PIMPLE: pRefCell", "found " + std::to_string(gas.pimple.referenceCell)
                                                                  + ", but the rank has "
                                                                  + std::to_string(mesh.nCells()) + " cells, from 0.");
    }
    // Conditions of the patches look for these by name.
    const Foam::volScalarField voidFraction(
        Foam::IOobject("voidFraction", mesh.time().timeName(), mesh, Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE),
        mesh, Foam::dimensionedScalar("one", Foam::dimless, 1));
    checkTimeSchemes(mesh, complaints);
    auto U = readField<Foam::volVectorField>("U", mesh, Foam::dimVelocity, "[0 1 -1 0 0 0 0]",
                                             "the velocity of the gas on every patch", complaints);
    auto p = readField<Foam::volScalarField>(
        "p", mesh, Foam::dimPressure, "[1 -1 -2 0 0 0 0]",
        "the pressure of the gas [Pa], without its hydrostatic part, on every patch", complaints);
    if (U.valid() && p.valid()) {
        Foam::surfaceScalarField flux(
            Foam::IOobject("phi", mesh.time().timeName(), mesh, Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE),
            mesh, Foam::dimensionedScalar("zero", Foam::dimVelocity * Foam::dimArea, 0));
        attempt("system/fvSchemes: interpolationSchemes", complaints, [&] { flux = Foam::fvc::flux(U()); });
        checkPatches(U(), p(), complaints);
        checkConditions(U.ref(), complaints);
        checkConditions(p.ref(), complaints);
        checkGasNumerics(mesh, flux, complaints);
        checkTurbulence(gas, voidFraction, U(), flux, complaints);
    }
}

void checkGasScene(const gasProperties& gas, const Foam::fvMesh& mesh, const DemPort& dem, Complaints& complaints)
{
    checkGravity(gas, dem, complaints);
    checkPeriodicity(mesh, dem, complaints);
    if (gas.maxDeltaT > 0 && gas.maxDeltaT < dem.timeStep() * (1 - 1e-9)) {
        complaints.add(std::string(gasFile) + ": maxDeltaT",
                       "the largest gas step " + shown(gas.maxDeltaT) + " s is below the DEM step "
                           + shown(dem.timeStep()) + " s. Raise it, or lower timestep in the DEM script.");
    }
    if (gas.adjustTimeStep && gas.maxDeltaT > 0 && mesh.time().deltaTValue() > gas.maxDeltaT * (1 + 1e-9)) {
        complaints.add("system/controlDict: deltaT",
                       "found " + shown(mesh.time().deltaTValue())
                           + " s for the first gas step, but maxDeltaT in constant/gasProperties allows "
                           + shown(gas.maxDeltaT) + " s. Write at most that.");
    }
    const double largest = 2 * dem.largestRadius();
    const double cell = std::cbrt(Foam::gMin(mesh.cellVolumes()));
    const VoidFractionModel model = gas.exchange.voidFraction;
    const std::string size = "the largest particle, " + shown(largest) + " m, is " + shown(largest / cell, 3)
                             + " times the smallest cell, " + shown(cell) + " m, ";
    if (model == VoidFractionModel::smoothed) {
        const double share = smoothedShare(largest / cell, gas.exchange.smoothingLength / cell);
        if (largest > cell && gas.exchange.smoothingLength < largest) {
            complaints.add(std::string(gasFile) + ": smoothingLength", size + "and is spread over "
                                                                           + shown(gas.exchange.smoothingLength)
                                                                           + " m only. Write at least its diameter.");
        } else if (share > mostOfACell) {
            complaints.add(std::string(gasFile) + ": smoothingLength",
                           size + "and spread over " + shown(gas.exchange.smoothingLength) + " m it still fills "
                               + shown(share, 3) + " of a cell by itself; allowed is " + shown(mostOfACell, 3)
                               + ". Write a larger length, or use larger cells.");
        }
        return;
    }
    const double allowed = gas.largestParticle > 0               ? gas.largestParticle
                           : model == VoidFractionModel::divided ? largestDivided
                                                                 : largestAtCentre;
    if (largest > allowed * cell) {
        complaints.add(std::string(gasFile) + ": voidFraction",
                       size
                           + (model == VoidFractionModel::divided ? "and `divided` lays a 15th of it into one cell"
                                                                  : "and `centre` lays it into one cell")
                           + "; allowed is " + shown(allowed, 3) + ". Write voidFraction "
                           + (model == VoidFractionModel::divided ? "smoothed;" : "divided; or smoothed;")
                           + " use larger cells, or raise largestParticle.");
    }
}

void printGas(const gasProperties& gas, const Foam::fvMesh& mesh)
{
    const GasSettings& exchange = gas.exchange;
    Foam::Info << "\nGas: density " << exchange.density << " kg/m3, viscosity " << exchange.viscosity << " Pa s, drag "
               << exchange.drag.c_str() << ", pressure gradient by "
               << (exchange.pressure == PressureModel::modelA ? "modelA" : "modelB") << ", void fraction "
               << voidFractionModelNames()[static_cast<std::size_t>(exchange.voidFraction)].c_str() << ", "
               << (exchange.velocity == VelocityInterpolation::cell ? "" : "velocity at particles by cellPoint, ")
               << (gas.turbulence.empty() ? "laminar" : "turbulence " + gas.turbulence).c_str() << ", "
               << Foam::returnReduce(mesh.nCells(), Foam::sumOp<Foam::label>()) << " cells\n";
    if (gas.adjustTimeStep) {
        Foam::Info << "    gas step by Courant number " << gas.maxCo << ", at most "
                   << (gas.maxDeltaT > 0 ? gas.maxDeltaT : mesh.time().deltaTValue()) << " s\n";
    }
    Foam::Info << Foam::endl;
}

}  // namespace him
