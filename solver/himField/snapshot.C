// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/snapshot.H"

#include "settings/checkedDictionary.H"
#include "settings/electricRegion.H"

#include "OSspecific.H"
#include "coupledPolyPatch.H"
#include "processorCyclicPolyPatch.H"
#include "processorPolyPatch.H"

#include <cmath>

namespace him {

namespace {

/// A face of a cyclic patch may be this much out of the axis.
constexpr double alignment = 1e-6;

/// Directions in which cyclic patches close the mesh. Collective.
std::array<bool, 3> periodicDirections(const Foam::fvMesh& mesh, Complaints& complaints)
{
    std::array<bool, 3> found{false, false, false};
    for (const Foam::polyPatch& patch : mesh.boundaryMesh()) {
        const bool cut = Foam::isA<Foam::processorPolyPatch>(patch);
        if (!patch.coupled() || (cut && !Foam::isA<Foam::processorCyclicPolyPatch>(patch))) {
            continue;
        }
        for (const Foam::vector& area : patch.faceAreas()) {
            const Foam::vector normal = area / Foam::mag(area);
            int axis = 0;
            for (int other = 1; other < 3; ++other) {
                axis = std::abs(normal[other]) > std::abs(normal[axis]) ? other : axis;
            }
            if (std::abs(normal[axis]) < 1 - alignment) {
                complaints.add(std::string(ofRegion("constant", mesh.name()) / "polyMesh/boundary") + ": " + patch.name(),
                               "the cyclic patch is not at right angles to x, y or z. Periodic copies are sought along "
                               "the axes only: turn the mesh, or close the patch with walls.");
                break;
            }
            found[static_cast<std::size_t>(axis)] = true;
        }
    }
    for (bool& direction : found) {
        Foam::reduce(direction, Foam::orOp<bool>());
    }
    return found;
}

bool needsMesh(const FieldSettings& settings)
{
    return FieldMethod::needsMesh(settings.method) || settings.pairwiseSum.images;
}

}  // namespace

FieldSettings snapshot::complete(const FieldSettings& settings) const
{
    FieldSettings whole = settings;
    whole.pairwiseSum.imageWalls = walls.mirrors;
    if (poisson && FieldMethod::needsCutoff(settings.method) && settings.nearCutoff == 0) {
        whole.nearCutoff = poisson->largestCellDiagonal();
    }
    return whole;
}

void openSnapshot(const Foam::argList& args, const std::vector<std::string>& names, bool openAny, snapshot& s,
                  Complaints& complaints)
{
    const Foam::fileName casePath = args.rootPath() / args.globalCaseName();
    checkControlDict(casePath, complaints);
    const bool timeOpens = complaints.none();
    s.choices = readFieldChoices(casePath, complaints);
    bool wanted = names.empty() && !s.choices.selected.method.empty() && needsMesh(s.choices.selected);
    for (const std::string& name : names) {
        const fieldChoice* choice = s.choices.find(name);
        if (!choice) {
            complaints.add("-method", "unknown name `" + name + "`; known: " + joined(s.choices.names())
                                          + ". A sub-dictionary of constant/electrostaticProperties with a fieldMethod "
                                            "of its own makes one more.");
        }
        wanted = wanted || (choice && needsMesh(choice->settings));
    }
    if (!timeOpens) {
        return;
    }
    s.runTime.reset(new Foam::Time(Foam::Time::controlDictName, args));
    if (wanted || (openAny && hasElectricMesh(s.runTime().globalPath()))) {
        s.mesh = openMesh(s.runTime(), complaints);
    }
    if (!s.mesh.valid()) {
        return;
    }
    s.periodic = periodicDirections(s.mesh(), complaints);
    s.poisson = openPoissonMesh(s.mesh(), s.choices.selected.permittivity, complaints,
                                s.choices.selected.neutralisingBackground, s.choices.dielectrics);
    if (s.poisson) {
        checkConditions(s.choices.selected, *s.poisson, complaints);
    }
    if (s.poisson) {
        s.box = s.poisson->globalBounds();
        const auto cells = static_cast<double>(Foam::returnReduce(s.mesh().nCells(), Foam::sumOp<Foam::label>()));
        s.cellSize = std::cbrt(Foam::gSum(s.mesh().cellVolumes()) / cells);
        s.walls = findMeshWalls(*s.poisson);
    }
}

}  // namespace him
