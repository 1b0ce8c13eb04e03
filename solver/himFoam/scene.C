// SPDX-License-Identifier: GPL-3.0-or-later
#include "himFoam/scene.H"

#include "gas/gasChecks.H"
#include "output/runReport.H"
#include "parallel/session.H"

#include "profiling.H"

#include <algorithm>

namespace him {

namespace {

void handElectrostaticsToDem(scene& s)
{
    std::vector<WallRole> roles;
    for (const auto& [wall, target] : s.settings.walls) {
        const bool keeps = s.poisson && wallCharges::isInsulating(target, s.poisson->matter());
        roles.push_back({wall, target != noTransfer, keeps});
    }
    s.dem->setWallRoles(roles);
    s.dem->setWallContactField(s.settings.wallContactField);
    s.dem->setPermittivity(s.settings.field.permittivity);
    const bool wallsCharge =
        std::any_of(roles.begin(), roles.end(), [](const WallRole& role) { return role.transfersCharge; });
    s.settings.field.ownResponse = s.dem->charging() && wallsCharge && !s.settings.fixedUniformCharge
                                   && s.settings.wallContactField == WallContactField::total;
}

}  // namespace

void openCase(const Foam::argList& args, scene& s, MPI_Comm communicator)
{
    const Foam::fileName casePath = args.rootPath() / args.globalCaseName();
    Complaints complaints;
    checkControlDict(casePath, complaints);
    const bool timeOpens = complaints.none();
    s.settings = readCaseSettings(casePath, complaints);
    if (timeOpens) {
        s.runTime.reset(new Foam::Time(Foam::Time::controlDictName, args));
        if (s.settings.needsMesh) {
            s.mesh = openMesh(s.runTime(), complaints);
        }
    }
    if (timeOpens && s.settings.gas) {
        if (!s.hasGasMesh()) {
            s.ownGasMesh = openGasMesh(s.runTime(), complaints);
        }
        if (s.hasGasMesh()) {
            checkGasFields(*s.settings.gas, s.gasMesh(), complaints);
        }
    }
    if (timeOpens && (!s.settings.gas || s.hasGasMesh())) {
        checkPressureDrop(s.settings.statistics, s.settings.gas ? &s.gasMesh() : nullptr, complaints);
    }
    if (s.mesh.valid()) {
        s.poisson =
            openPoissonMesh(s.mesh(), s.settings.field.permittivity, complaints,
                            s.settings.field.neutralisingBackground, s.settings.dielectrics, s.settings.field.accuracy);
    }
    if (s.poisson) {
        checkConditions(s.settings.field, *s.poisson, complaints);
        checkCutoff(s.settings.field, *s.poisson, complaints);
    }
    if (s.settings.electrostatics && !s.settings.needsMesh && s.settings.dielectrics.any()) {
        complaints.add(
            "constant/electrostaticProperties: insulatingWalls, zonePermittivity",
            "fieldMethod " + s.settings.field.method
                + " reads no mesh, so it knows of no such walls and zones. Use him, himCell or p3m, or remove them.");
    }
    if (s.settings.electrostatics && (s.poisson || !s.settings.needsMesh)) {
        checkWallTargets(s.settings, s.poisson.get(), complaints);
    }
    stopOnComplaints(complaints, "Dictionaries, mesh and fields", communicator);
}

void openDem(scene& s, MPI_Comm communicator)
{
    const Foam::fileName casePath = s.runTime().globalPath();
    const Foam::fileName script(s.settings.demScript);
    Foam::Info << "LIGGGHTS reads " << script << Foam::endl;
    DemOptions options;
    options.script = script;
    options.directory = casePath;
    options.logFile = script.path() / "log.liggghts";
    options.needsCharge = s.settings.electrostatics;
    options.hasGas = s.settings.gas.has_value();
    options.variables = {{"startTime", s.runTime().timeName()}};
    s.dem = openLiggghts(options, communicator);

    Complaints complaints = s.dem->check();
    s.demSteps = demStepsPerUpdate(s.runTime().deltaTValue(), s.dem->timeStep(), complaints);
    if (s.settings.electrostatics) {
        checkWalls(s.settings, *s.dem, complaints);
        checkDimensions(s.settings, *s.dem, complaints);
    }
    checkNearField(s.settings.field.nearField, s.demSteps, complaints);
    findImageWalls(s.settings, *s.dem, complaints);
    chooseByAccuracy(s.settings, *s.dem, s.poisson.get(), communicator, complaints);
    if (s.settings.electrostatics) {
        checkPointField(s.settings, *s.dem, complaints);
    }
    if (s.poisson) {
        checkParticlesInMesh(s.settings, *s.dem, *s.poisson, communicator, complaints);
        checkGroundedWalls(s.settings, *s.dem, *s.poisson, communicator, complaints);
        s.insulatingWalls = wallCharges::create(s.settings, *s.dem, *s.poisson, communicator, complaints);
    }
    s.dem->allowRemovals(s.settings.allowRemovals);
    if (s.settings.electrostatics) {
        handElectrostaticsToDem(s);
    }
    checkUniformCharge(s.settings, *s.dem, communicator, complaints);
    checkProjectiveCharging(s.settings, *s.dem, complaints);
    s.statisticsRegions = completeRegions(s.settings.statistics, *s.dem, communicator, complaints);
    if (s.settings.gas) {
        checkGasScene(*s.settings.gas, s.gasMesh(), *s.dem, complaints);
        checkGasWalls(s.settings, *s.dem, s.gasMesh(), communicator, complaints);
    }
    stopOnComplaints(complaints, "Case and DEM script together", communicator);
    if (s.settings.gas) {
        printGas(*s.settings.gas, s.gasMesh());
    }
    printScene(s.settings, *s.dem, s.poisson.get(), s.runTime().deltaTValue(), s.demSteps);
}

}  // namespace him
