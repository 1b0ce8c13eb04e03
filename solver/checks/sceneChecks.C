// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"

#include "settings/checkedDictionary.H"

#include "dem_coupling/exchange/mesh_locator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace him {

namespace {

/// deltaT/timeStep may differ from an integer by this much.
constexpr double ratioTolerance = 1e-9;

/// A net charge above this share of all charges counts as one.
constexpr double neutrality = 1e-9;

/// How many particles outside the mesh are named by each rank.
constexpr std::size_t namedParticles = 3;

std::string shownBox(const Box& box)
{
    const auto corner = [](const Vector3& p) {
        return "(" + shown(p.x()) + " " + shown(p.y()) + " " + shown(p.z()) + ")";
    };
    return corner(box.lower) + " to " + corner(box.upper) + " m";
}

std::vector<std::string> namesOf(const std::vector<DemWall>& walls)
{
    std::vector<std::string> names;
    std::transform(walls.begin(), walls.end(), std::back_inserter(names),
                   [](const DemWall& wall) { return wall.name; });
    return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

void refuseParticlesOutside(const DemPort& dem, const DemParticles& particles, const foamPoissonMesh& mesh,
                            MPI_Comm communicator, Complaints& complaints)
{
    MeshLocator locator(mesh, communicator, dem.box(), dem.periodic());
    locator.locate(particles.position);
    std::string named;
    std::size_t outside = 0;
    for (Index row = 0; row < particles.size(); ++row) {
        if (!locator.inMesh(row) && ++outside <= namedParticles) {
            const auto p = particles.position.row(row);
            named += (named.empty() ? "" : ", ") + std::string("particle ")
                     + std::to_string(particles.tag[static_cast<std::size_t>(row)]) + " at (" + shown(p[0]) + " "
                     + shown(p[1]) + " " + shown(p[2]) + ") m";
        }
    }
    if (outside > 0) {
        complaints.add("DEM scene", std::to_string(outside) + " particle(s) lie outside the mesh: " + named
                                        + (outside > namedParticles ? ", ..." : "") + ". The mesh covers "
                                        + shownBox(mesh.globalBounds())
                                        + ". Move them or enlarge the mesh, or write "
                                          "particlesOutsideMesh excluded; in constant/couplingProperties.");
    }
}

void refuseChargeWithoutVoltage(const caseSettings& settings, const DemPort& dem, const DemParticles& particles,
                                MPI_Comm communicator, Complaints& complaints)
{
    std::array<double, 2> sums{particles.charge.sum(), particles.charge.abs().sum()};
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, communicator);
    const bool wallsGiveCharge = dem.charging()
                                 && std::any_of(settings.walls.begin(), settings.walls.end(),
                                                [](const auto& wall) { return wall.second != noTransfer; });
    if (std::abs(sums[0]) > neutrality * sums[1] || wallsGiveCharge) {
        complaints.add("electricPotential",
                       "no patch fixes the voltage, but the particles "
                           + (wallsGiveCharge ? std::string("will be charged at walls")
                                              : "carry a net charge of " + shown(sums[0]) + " C")
                           + ", and its field lines need somewhere to end. Give one patch a fixedValue, or "
                             "write neutralisingBackground yes; in constant/electrostaticProperties.");
    }
}

}  // namespace

long demStepsPerUpdate(double deltaT, double timeStep, Complaints& complaints)
{
    const double ratio = deltaT / timeStep;
    if (ratio < 1 - ratioTolerance) {
        complaints.add(
            "system/controlDict: deltaT",
            "found " + shown(deltaT, 12) + " s, but the DEM takes steps of " + shown(timeStep, 12)
                + " s (timestep in the DEM script), and field and gas can not take shorter ones. The nearest "
                  "allowed deltaT is "
                + shown(timeStep, 15) + ".");
        return 0;
    }
    const double nearest = std::max(1.0, std::round(ratio));
    if (std::abs(ratio - nearest) > ratioTolerance) {
        complaints.add("system/controlDict: deltaT",
                       shown(deltaT, 12) + " s is not a multiple of the DEM time step, " + shown(timeStep, 12)
                           + " s (timestep in the DEM script); the ratio is " + shown(ratio, 12)
                           + ". The nearest allowed deltaT is " + shown(nearest * timeStep, 15) + ".");
        return 0;
    }
    return static_cast<long>(nearest);
}

void checkNearField(const NearFieldSettings& nearField, long demSteps, Complaints& complaints)
{
    if (demSteps > 0 && nearField.interval > demSteps) {
        complaints.add("constant/electrostaticProperties: nearField.interval",
                       std::to_string(nearField.interval) + " DEM steps are more than the " + std::to_string(demSteps)
                           + " of a field update (deltaT). Use at most half of those, or leave nearField out.");
    }
}

void checkWalls(const caseSettings& settings, const DemPort& dem, Complaints& complaints)
{
    const std::string where = "constant/couplingProperties: walls";
    const std::vector<std::string> demNames = namesOf(dem.walls());
    std::vector<std::string> mapped;
    for (const auto& [wall, target] : settings.walls) {
        mapped.push_back(wall);
        if (!contains(demNames, wall)) {
            complaints.add(where + ": " + wall, "the DEM script has no wall of this name; it has: "
                                                    + (demNames.empty() ? "none" : joined(demNames)) + ".");
        }
    }
    std::vector<std::string> unmapped;
    std::copy_if(demNames.begin(), demNames.end(), std::back_inserter(unmapped),
                 [&](const std::string& name) { return !contains(mapped, name); });
    if (!unmapped.empty()) {
        complaints.add(where, "the DEM wall(s) " + joined(unmapped) + " are not in the table. Map each one to "
                                  + (settings.needsMesh ? "a patch" : "grounded") + " or to noTransfer.");
    }
}

void checkDimensions(const caseSettings& settings, const DemPort& dem, Complaints& complaints)
{
    const std::string plane = dem.planeOfMotion();
    if (plane.empty() || !FieldMethod::needsMesh(settings.field.method)) {
        return;
    }
    complaints.add(
        "constant/electrostaticProperties: fieldMethod",
        settings.field.method + " has a mesh, but the DEM script confines spheres to the plane " + plane
            + " (fix constrain/plane). The mesh ends in front of and behind that plane, and its boundaries there would "
              "screen the charges, where a two-dimensional scene has nothing. Use pairwiseSum or directTruncation, or "
              "take the constraint out.");
}

void checkPointField(const caseSettings& settings, const DemPort& dem, Complaints& complaints)
{
    const auto* user = dynamic_cast<const PointFieldUser*>(&dem);
    if (!user || !user->usesPointField()) {
        return;
    }
    if (settings.wallContactField == WallContactField::self) {
        complaints.add("constant/couplingProperties: wallContactField",
                       "self leaves the field of the others out at walls, so `wallField atContactPoint` of the DEM "
                       "script has nothing to act on. Take one of them out.");
    } else if (!FieldMethod::knowsPoints(settings.field.method)) {
        complaints.add("DEM script: wallField", FieldMethod::noPointsText(settings.field.method) + ".");
    }
}

void findImageWalls(caseSettings& settings, const DemPort& dem, Complaints& complaints)
{
    PairwiseSumSettings& sum = settings.field.pairwiseSum;
    if (settings.field.method != "pairwiseSum" || !sum.images) {
        return;
    }
    const std::string where = "constant/electrostaticProperties: pairwiseSumCoeffs: images";
    sum.imageWalls.clear();
    for (const DemWall& wall : dem.walls()) {
        const auto mapped = std::find_if(settings.walls.begin(), settings.walls.end(),
                                         [&](const auto& entry) { return entry.first == wall.name; });
        if (mapped == settings.walls.end() || mapped->second == noTransfer) {
            continue;
        }
        if (!wall.primitive) {
            complaints.add(where,
                           "the grounded DEM wall " + wall.name
                               + " is a mesh, and the pair sum mirrors charges in planes and cylinders only. Use "
                                 "primitive walls, or fieldMethod p3m.");
        } else {
            sum.imageWalls.push_back(wall.image);
        }
    }
    if (sum.imageWalls.empty() && settings.methodByAccuracy) {
        sum.images = false;
    } else if (sum.imageWalls.empty() && complaints.none()) {
        complaints.add(where, "the DEM scene has no grounded wall to mirror charges in. Map walls to grounded in "
                              "constant/couplingProperties, or write images no.");
    }
}

void checkParticlesInMesh(const caseSettings& settings, const DemPort& dem, const foamPoissonMesh& mesh,
                          MPI_Comm communicator, Complaints& complaints)
{
    DemParticles particles;
    dem.particles(particles);
    if (!mesh.globalBounds().overlaps(dem.box())) {
        complaints.add("constant/polyMesh", "the mesh, " + shownBox(mesh.globalBounds()) + ", and the DEM box, "
                                                + shownBox(dem.box())
                                                + ", do not overlap. Check the units of both (metres).");
    } else if (settings.field.outsideMesh == OutsideMesh::error) {
        refuseParticlesOutside(dem, particles, mesh, communicator, complaints);
    }
    if (!mesh.potentialIsFixed() && !mesh.neutralisingBackground()) {
        refuseChargeWithoutVoltage(settings, dem, particles, communicator, complaints);
    }
}

}  // namespace him
