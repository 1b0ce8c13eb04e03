// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    meshProbe

Description
    Says about the mesh of a case what p3m relies on, one "name value" a line:
    sums over the arrays that a closed mesh makes zero, and how far a solve
    with boundary values of its own is from a known potential.

Usage
    meshProbe [-case DIR] [-parallel]
\*---------------------------------------------------------------------------*/
#include "checks/caseChecks.H"
#include "foamPoissonMesh/conversions.H"
#include "parallel/session.H"

#include "argList.H"

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

namespace {

using namespace him;
using Foam::maxOp;
using Foam::returnReduce;
using Foam::sumOp;

constexpr double permittivity = 8.8541878128e-12;

void say(const char* name, double value)
{
    if (Foam::Pstream::master()) {
        std::printf("%s %.17g\n", name, value);
    }
}

double most(double value)
{
    return returnReduce(Foam::scalar(value), maxOp<Foam::scalar>());
}

double sum(double value)
{
    return returnReduce(Foam::scalar(value), sumOp<Foam::scalar>());
}

Vector3 rowOf(const Points& points, Index row)
{
    return points.row(row).matrix().transpose();
}

/// Largest sum of a cell's outward area vectors over its surface: zero when no face is missing or turned round.
double openness(const MeshArrays& mesh)
{
    Points sums = Points::Zero(mesh.cells(), 3);
    Scalars areas = Scalars::Zero(mesh.cells());
    const auto add = [&](std::int32_t cell, const Vector3& area) {
        sums.row(cell) += area.transpose().array();
        areas[cell] += area.norm();
    };
    for (Index face = 0; face < mesh.internal.size(); ++face) {
        const auto f = static_cast<std::size_t>(face);
        add(mesh.internal.owner[f], rowOf(mesh.internal.areaVector, face));
        add(mesh.internal.neighbour[f], -rowOf(mesh.internal.areaVector, face));
    }
    for (Index face = 0; face < mesh.boundary.size(); ++face) {
        add(mesh.boundary.cell[static_cast<std::size_t>(face)],
            mesh.boundary.area[face] * rowOf(mesh.boundary.normal, face));
    }
    for (Index face = 0; face < mesh.coupled.size(); ++face) {
        add(mesh.coupled.cell[static_cast<std::size_t>(face)], rowOf(mesh.coupled.areaVector, face));
    }
    double worst = 0;
    for (Index cell = 0; cell < mesh.cells(); ++cell) {
        worst = std::max(worst, rowOf(sums, cell).norm() / areas[cell]);
    }
    return most(worst);
}

/// Centres of all ranks' cells, rank by rank.
std::vector<Points> centresOfAll(const MeshArrays& mesh)
{
    Foam::List<Foam::vectorField> all(Foam::Pstream::nProcs());
    Foam::vectorField& own = all[Foam::Pstream::myProcNo()];
    own.setSize(static_cast<Foam::label>(mesh.cells()));
    forAll(own, cell)
    {
        own[cell] = toFoam(rowOf(mesh.centre, cell));
    }
    Foam::Pstream::gatherList(all);
    Foam::Pstream::scatterList(all);
    std::vector<Points> centres;
    for (const Foam::vectorField& ofRank : all) {
        centres.emplace_back(ofRank.size(), 3);
        forAll(ofRank, cell)
        {
            centres.back().row(cell) = toEigen(ofRank[cell]).transpose().array();
        }
    }
    return centres;
}

/// How far the middle between a cell and its copy beyond a coupled face is from the face, over the distance of the two.
/// Zero on uniform boxes; large when the cell number, rank or shift is wrong.
void sayCoupled(const MeshArrays& mesh)
{
    const std::vector<Points> centres = centresOfAll(mesh);
    double worst = 0;
    double shifted = 0;
    double largestShift = 0;
    for (Index face = 0; face < mesh.coupled.size(); ++face) {
        const auto f = static_cast<std::size_t>(face);
        const Vector3 own = rowOf(mesh.centre, mesh.coupled.cell[f]);
        const Vector3 shift = rowOf(mesh.coupled.shift, face);
        const Vector3 copy =
            rowOf(centres[static_cast<std::size_t>(mesh.coupled.otherRank[f])], mesh.coupled.otherCell[f]) + shift;
        const Vector3 middle = 0.5 * (own + copy);
        worst = std::max(worst, (middle - rowOf(mesh.coupled.centre, face)).norm() / (copy - own).norm());
        if ((copy - own).dot(rowOf(mesh.coupled.areaVector, face)) <= 0) {
            worst = 1e9;
        }
        shifted += shift.isZero(0) ? 0 : 1;
        largestShift = std::max(largestShift, shift.norm());
    }
    say("coupledOffset", most(worst));
    say("coupledFaces", sum(static_cast<double>(mesh.coupled.size())));
    say("shiftedFaces", sum(shifted));
    say("largestShift", most(largestShift));
}

void saySizes(const MeshArrays& mesh)
{
    double conductors = 0;
    double insulated = 0;
    double voltage = 0;
    for (Index face = 0; face < mesh.boundary.size(); ++face) {
        const bool conductor = mesh.boundary.condition[static_cast<std::size_t>(face)] == FaceCondition::conductor;
        (conductor ? conductors : insulated) += mesh.boundary.area[face];
        voltage += mesh.boundary.area[face] * mesh.boundary.value[face];
    }
    say("cells", sum(static_cast<double>(mesh.cells())));
    say("volume", sum(mesh.volume.sum()));
    say("conductorArea", sum(conductors));
    say("insulatedArea", sum(insulated));
    say("voltageTimesArea", sum(voltage));
}

struct Potential {
    const char* name;
    std::function<double(const Vector3&)> value;
    std::function<Vector3(const Vector3&)> gradient;
    double laplacian;
};

/// Boundary values of a known potential.
Scalars valuesOf(const Potential& exact, const BoundaryFaces& faces)
{
    Scalars values(faces.size());
    for (Index face = 0; face < faces.size(); ++face) {
        const Vector3 centre = rowOf(faces.centre, face);
        values[face] = faces.condition[static_cast<std::size_t>(face)] == FaceCondition::conductor
                           ? exact.value(centre)
                           : exact.gradient(centre).dot(rowOf(faces.normal, face));
    }
    return values;
}

/// Largest error of the solved potential in a cell [V]; the known potentials are of the order of 1 V.
double errorOf(const Potential& exact, const foamPoissonMesh& poisson)
{
    double worst = 0;
    for (Index cell = 0; cell < poisson.cellCount(); ++cell) {
        worst = std::max(worst, std::abs(poisson.potential(cell) - exact.value(poisson.cellCentre(cell))));
    }
    return most(worst);
}

void saySolutions(foamPoissonMesh& poisson)
{
    const MeshArrays& mesh = poisson.arrays();
    const std::vector<Potential> potentials{
        {"linearError", [](const Vector3& x) { return 1 + 3 * x[0] - 2 * x[1] + 5 * x[2]; },
         [](const Vector3&) { return Vector3(3, -2, 5); }, 0},
        {"quadraticError", [](const Vector3& x) { return 80 * x[0] * x[0] + 50 * x[1] * x[2]; },
         [](const Vector3& x) { return Vector3(160 * x[0], 50 * x[2], 50 * x[1]); }, 160}};
    for (const Potential& exact : potentials) {
        poisson.solve(-exact.laplacian * permittivity * mesh.volume, valuesOf(exact, mesh.boundary));
        say(exact.name, errorOf(exact, poisson));
    }
    // The charge in two instalments: a solve without it, then a correction that brings it.
    const Potential& exact = potentials[1];
    const Scalars charge = -exact.laplacian * permittivity * mesh.volume;
    poisson.solve(Scalars(0.25 * charge), valuesOf(exact, mesh.boundary));
    say("withoutCorrection", errorOf(exact, poisson));
    poisson.correct(0.5 * charge);
    poisson.correct(0.25 * charge);
    say("correctedError", errorOf(exact, poisson));
}

/// Of points in and around every cell: the share that the cell surely holds, and how many of those find() gives to another.
void saySurelyHeld(const Foam::fvMesh& mesh, const foamPoissonMesh& poisson)
{
    double asked = 0;
    double held = 0;
    double elsewhere = 0;
    forAll(mesh.cells(), cell)
    {
        Box box;
        for (const Foam::label point : mesh.cellPoints()[cell]) {
            box.extend(toEigen(mesh.points()[point]));
        }
        // Eighths of the edges, so that some points lie on the faces of boxes.
        for (int n = 0; n < 11 * 11 * 11; ++n) {
            const Vector3 eighths(n % 11 - 5, n / 11 % 11 - 5, n / 121 - 5);
            const Vector3 point = 0.5 * (box.lower + box.upper) + 0.125 * eighths.cwiseProduct(box.size());
            asked += 1;
            if (poisson.surelyHolds(cell, point)) {
                held += 1;
                elsewhere += poisson.findCell(point) == cell ? 0 : 1;
            }
        }
    }
    say("surelyHeld", sum(held) / sum(asked));
    say("heldElsewhere", sum(elsewhere));
}

}  // namespace

int main(int argc, char* argv[])
{
    Foam::argList::noCheckProcessorDirectories();
    Foam::argList args(argc, argv);
    const MPI_Comm communicator = him::openSession("meshProbe");
    him::Complaints complaints;
    const Foam::fileName casePath = args.rootPath() / args.globalCaseName();
    const him::caseSettings settings = him::readCaseSettings(casePath, complaints);
    Foam::Time runTime(Foam::Time::controlDictName, args);
    Foam::autoPtr<Foam::fvMesh> mesh = him::openMesh(runTime, complaints);
    him::stopOnComplaints(complaints, "Probe", communicator);
    const auto poisson = him::openPoissonMesh(mesh(), permittivity, complaints, true);
    if (poisson) {
        him::FieldSettings p3m;
        p3m.method = "p3m";
        him::checkConditions(p3m, *poisson, complaints);
    }
    him::stopOnComplaints(complaints, "Probe", communicator);
    static_cast<void>(settings);
    poisson->solve(him::Scalars::Zero(poisson->cellCount()));
    say("direct", poisson->description().find("direct solve") != std::string::npos);
    say("openness", openness(poisson->arrays()));
    saySizes(poisson->arrays());
    sayCoupled(poisson->arrays());
    saySurelyHeld(mesh(), *poisson);
    saySolutions(*poisson);
    return 0;
}
