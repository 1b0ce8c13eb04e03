// SPDX-License-Identifier: GPL-3.0-or-later
// Finding permittivities, walls and their faces in the mesh.
#include "foamPoissonMesh/dielectrics.H"

#include "foamPoissonMesh/insulatingWallFvPatchScalarField.H"
#include "settings/electricRegion.H"

#include "OSspecific.H"
#include "cyclicPolyPatch.H"
#include "processorCyclicPolyPatch.H"
#include "processorPolyPatch.H"
#include "syncTools.H"

namespace him {

namespace {

using namespace Foam;

constexpr const char* propertiesFile = "constant/electrostaticProperties: ";
constexpr const char* noZone = "none";

std::vector<std::string> namesOf(const wordList& words)
{
    return {words.begin(), words.end()};
}

/// Cell zone of every cell, -1: none.
labelList zonesOfCells(const fvMesh& mesh)
{
    labelList zones(mesh.nCells(), -1);
    forAll(mesh.cellZones(), zone)
    {
        for (const label cell : mesh.cellZones()[zone]) {
            zones[cell] = zone;
        }
    }
    return zones;
}

/// Zone of the cell on the other side of every face of the mesh, as far as a cell of this rank is at this one.
labelList zonesAcross(const fvMesh& mesh, const labelList& zones)
{
    labelList across;
    syncTools::swapBoundaryCellList(mesh, zones, across);
    return across;
}

/// Faces between cells of zone a and cells of zone b, those to other ranks and periodic copies included.
std::vector<label> facesBetween(const fvMesh& mesh, const labelList& zones, const labelList& across, label a, label b)
{
    const auto between = [&](label here, label there) {
        return (here == a && there == b) || (here == b && there == a);
    };
    std::vector<label> found;
    for (label face = 0; face < mesh.nInternalFaces(); ++face) {
        if (between(zones[mesh.faceOwner()[face]], zones[mesh.faceNeighbour()[face]])) {
            found.push_back(face);
        }
    }
    for (const polyPatch& patch : mesh.boundaryMesh()) {
        forAll(patch, i)
        {
            const label face = patch.start() + i;
            if (patch.coupled() && between(zones[mesh.faceOwner()[face]], across[face - mesh.nInternalFaces()])) {
                found.push_back(face);
            }
        }
    }
    return found;
}

}  // namespace

std::unique_ptr<dielectrics> dielectrics::create(const dielectricChoices& choices, double permittivity,
                                                 volScalarField& potential, Complaints& complaints)
{
    bool patches = false;
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        patches = patches || isA<insulatingWallFvPatchScalarField>(patch);
    }
    if (!choices.any() && !returnReduce(patches, orOp<bool>())) {
        return nullptr;
    }
    const std::size_t before = complaints.lines().size();
    std::unique_ptr<dielectrics> made(new dielectrics(permittivity, potential));
    const fileName written(made->sigma_.objectPath());
    if (!made->continued_ && returnReduce(isFile(written), orOp<bool>())) {
        complaints.add(
            potential.time().timeName() + "/wallSurfaceCharge",
            "the file is no surfaceScalarField on every rank. Continue from a time that has one, or remove it to begin "
            "without charge on the walls.");
    }
    made->setPermittivity(choices, complaints);
    made->findWalls(choices, potential, complaints);
    if (returnReduce(complaints.lines().size() > before, orOp<bool>())) {
        return nullptr;
    }
    made->updatePatches(potential);
    return made;
}

void dielectrics::setPermittivity(const dielectricChoices& choices, Complaints& complaints)
{
    const fvMesh& mesh = relative_.mesh();
    for (const auto& [name, value] : choices.permittivity) {
        const label zone = mesh.cellZones().findZoneID(name);
        if (zone < 0) {
            complaints.add(
                std::string(propertiesFile) + "zonePermittivity: " + name,
                "the mesh has no cell zone of this name; it has: " + joined(namesOf(mesh.cellZones().names())) + ".");
            continue;
        }
        for (const label cell : mesh.cellZones()[zone]) {
            relative_[cell] = value / choices.gas;
        }
    }
    relative_.correctBoundaryConditions();
    uniform_ = gMin(relative_.primitiveField()) == 1 && gMax(relative_.primitiveField()) == 1;
}

void dielectrics::findWalls(const dielectricChoices& choices, const volScalarField& potential, Complaints& complaints)
{
    const fvMesh& mesh = relative_.mesh();
    const labelList zones = zonesOfCells(mesh);
    const labelList across = zonesAcross(mesh, zones);
    labelList wallOfFace(mesh.nFaces(), -1);
    for (const insulatingWallChoice& choice : choices.walls) {
        const std::string where = std::string(propertiesFile) + "insulatingWalls: " + choice.name;
        const int wall = static_cast<int>(names_.size());
        names_.push_back(choice.name);
        if (choice.faceZone.empty() && choice.zones.first.empty()) {
            continue;  // what is wrong has been said
        }
        if (mesh.boundaryMesh().findPatchID(choice.name) >= 0) {
            complaints.add(where, "a patch has this name as well. Give the wall another one.");
        }
        std::vector<label> found;
        if (!choice.faceZone.empty()) {
            const label zone = mesh.faceZones().findZoneID(choice.faceZone);
            if (zone < 0) {
                complaints.add(where, "the mesh has no face zone " + choice.faceZone
                                          + "; it has: " + joined(namesOf(mesh.faceZones().names())) + ".");
                continue;
            }
            found.assign(mesh.faceZones()[zone].begin(), mesh.faceZones()[zone].end());
        } else {
            const auto zoneOf = [&](const std::string& name) {
                const label zone = name == noZone ? -1 : mesh.cellZones().findZoneID(name);
                if (name != noZone && zone < 0) {
                    complaints.add(where, "the mesh has no cell zone " + name + "; it has: "
                                              + joined(namesOf(mesh.cellZones().names())) + ", and none for the rest.");
                }
                return zone;
            };
            const label a = zoneOf(choice.zones.first);
            const label b = zoneOf(choice.zones.second);
            if (a != b) {
                found = facesBetween(mesh, zones, across, a, b);
            }
        }
        bool atEdge = false;
        bool periodic = false;
        bool twice = false;
        for (const label face : found) {
            if (face >= mesh.nInternalFaces()) {
                const polyPatch& patch = mesh.boundaryMesh()[mesh.boundaryMesh().whichPatch(face)];
                atEdge = atEdge || !patch.coupled();
                periodic = periodic || isA<cyclicPolyPatch>(patch) || isA<processorCyclicPolyPatch>(patch);
            }
            twice = twice || wallOfFace[face] >= 0;
            wallOfFace[face] = wall;
        }
        if (returnReduce(found.empty(), andOp<bool>())) {
            complaints.add(where,
                           "the wall has no face of the mesh that could carry its charge. Name a face zone with faces, "
                           "or two cell zones that touch.");
        }
        if (returnReduce(atEdge, orOp<bool>())) {
            complaints.add(where,
                           "face zone " + choice.faceZone
                               + " has faces at the edge of the mesh. Give their patch the condition insulatingWall in "
                                 "electricPotential, or mesh the outside of the wall.");
        }
        if (returnReduce(periodic, orOp<bool>())) {
            complaints.add(
                where,
                "some of its faces lie on a periodic patch, where each has two places and its charge none of its own. "
                "Shift the mesh against its period, so that the wall lies inside it.");
        }
        if (returnReduce(twice, orOp<bool>())) {
            complaints.add(where, "some of its faces belong to another insulating wall as well.");
        }
    }
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        if (isA<insulatingWallFvPatchScalarField>(patch)) {
            forAll(patch, i)
            {
                wallOfFace[patch.patch().start() + i] = static_cast<int>(names_.size());
            }
            names_.push_back(patch.patch().name());
        }
    }
    findFaces(potential, wallOfFace);
}

void dielectrics::findFaces(const volScalarField& potential, const labelList& wallOfFace)
{
    const fvMesh& mesh = relative_.mesh();
    const auto add = [&](label patch, label index, label cell, label other, const scalar weight, scalar length,
                         scalar own, scalar across, scalar area, int wall, bool counted) {
        if (own != across || wall >= 0) {
            faces_.push_back({patch, index, cell, other, own / ((1 - weight) * length), across / (weight * length),
                              area, wall, counted});
        }
    };
    const auto harmonic = [](scalar weight, scalar own, scalar across) {
        return own == across ? own : 1 / ((1 - weight) / own + weight / across);
    };
    for (label face = 0; face < mesh.nInternalFaces(); ++face) {
        const label cell = mesh.owner()[face];
        const label other = mesh.neighbour()[face];
        const scalar weight = mesh.weights()[face];
        const scalar length = (mesh.C()[other] - mesh.C()[cell]) & mesh.Sf()[face] / mesh.magSf()[face];
        ratio_[face] = harmonic(weight, relative_[cell], relative_[other]);
        add(-1, face, cell, other, weight, length, relative_[cell], relative_[other], mesh.magSf()[face],
            wallOfFace[face], true);
    }
    forAll(mesh.boundary(), patch)
    {
        const fvPatch& faces = mesh.boundary()[patch];
        const scalarField own(relative_.boundaryField()[patch].patchInternalField());
        if (!faces.coupled()) {
            ratio_.boundaryFieldRef()[patch] = own;
            if (isA<insulatingWallFvPatchScalarField>(potential.boundaryField()[patch])) {
                forAll(faces, i)
                {
                    faces_.push_back({patch, i, faces.faceCells()[i], -1, 0, 0, faces.magSf()[i],
                                      static_cast<int>(wallOfFace[faces.start() + i]), true});
                }
            }
            continue;
        }
        const scalarField across(relative_.boundaryField()[patch].patchNeighbourField());
        const scalarField& weights = mesh.weights().boundaryField()[patch];
        const scalarField lengths(faces.nf() & faces.delta());
        const auto* processor = dynamic_cast<const processorPolyPatch*>(&faces.patch());
        forAll(faces, i)
        {
            ratio_.boundaryFieldRef()[patch][i] = harmonic(weights[i], own[i], across[i]);
            add(patch, i, faces.faceCells()[i], -1, weights[i], lengths[i], own[i], across[i], faces.magSf()[i],
                wallOfFace[faces.start() + i], processor && processor->owner());
        }
    }
    for (std::size_t n = 0; n < faces_.size(); ++n) {
        if (faces_[n].wall >= 0 && faces_[n].counted) {
            owned_.push_back(n);
        }
    }
}

}  // namespace him
