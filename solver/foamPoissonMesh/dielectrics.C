// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/dielectrics.H"

#include "foamPoissonMesh/conversions.H"
#include "foamPoissonMesh/insulatingWallFvPatchScalarField.H"
#include "settings/electricRegion.H"

#include "linear.H"
#include "processorPolyPatch.H"
#include "syncTools.H"

#include <algorithm>

namespace him {

namespace {

using namespace Foam;

const dimensionSet dimSurfaceCharge(0, -2, 1, 0, 0, 1, 0);

/// More digits than a double has.
constexpr unsigned int allDigits = 17;

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

}  // namespace

dielectrics::dielectrics(double permittivity, volScalarField& potential)
    : permittivity_(permittivity),
      relative_(IOobject("permittivityOverGas", potential.time().timeName(), potential.mesh()), potential.mesh(),
                dimensionedScalar("one", dimless, 1.0)),
      ratio_(IOobject("permittivityRatio", potential.time().timeName(), potential.mesh()), potential.mesh(),
             dimensionedScalar("one", dimless, 1.0)),
      sigma_(IOobject("wallSurfaceCharge", potential.time().timeName(), potential.mesh(), IOobject::READ_IF_PRESENT),
             potential.mesh(), dimensionedScalar(dimSurfaceCharge, Zero))
{
}

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
            complaints.add(std::string(propertiesFile) + "zonePermittivity: " + name,
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
            const auto between = [&](label here, label there) {
                return a != b && ((here == a && there == b) || (here == b && there == a));
            };
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
        }
        bool atEdge = false;
        bool twice = false;
        for (const label face : found) {
            atEdge = atEdge || (face >= mesh.nInternalFaces() && !mesh.boundaryMesh()[mesh.boundaryMesh().whichPatch(face)].coupled());
            twice = twice || wallOfFace[face] >= 0;
            wallOfFace[face] = wall;
        }
        if (returnReduce(found.empty(), andOp<bool>())) {
            complaints.add(where, "the wall has no face of the mesh that could carry its charge. Name a face zone with faces, "
                                  "or two cell zones that touch.");
        }
        if (returnReduce(atEdge, orOp<bool>())) {
            complaints.add(where, "face zone " + choice.faceZone
                                      + " has faces at the edge of the mesh. Give their patch the condition insulatingWall in "
                                        "electricPotential, or mesh the outside of the wall.");
        }
        if (returnReduce(twice, orOp<bool>())) {
            complaints.add(where, "some of its faces belong to another insulating wall as well.");
        }
    }
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        if (isA<insulatingWallFvPatchScalarField>(patch)) {
            forAll(patch, i) { wallOfFace[patch.patch().start() + i] = static_cast<int>(names_.size()); }
            names_.push_back(patch.patch().name());
        }
    }
    findFaces(potential, wallOfFace);
}

void dielectrics::findFaces(const volScalarField& potential, const labelList& wallOfFace)
{
    const fvMesh& mesh = relative_.mesh();
    const auto add = [&](label patch, label index, label cell, label other, const scalar weight, scalar length, scalar own,
                         scalar across, scalar area, int wall, bool counted) {
        if (own != across || wall >= 0) {
            faces_.push_back({patch, index, cell, other, own / ((1 - weight) * length), across / (weight * length), area, wall,
                              counted});
            hasInternalWalls_ = hasInternalWalls_ || wall >= 0;
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
        add(-1, face, cell, other, weight, length, relative_[cell], relative_[other], mesh.magSf()[face], wallOfFace[face], true);
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
    reduce(hasInternalWalls_, orOp<bool>());
}

double dielectrics::chargeOf(const specialFace& face) const
{
    return face.patch < 0 ? sigma_[face.index] : sigma_.boundaryField()[face.patch][face.index];
}

double& dielectrics::chargeOf(const specialFace& face)
{
    return face.patch < 0 ? sigma_[face.index] : sigma_.boundaryFieldRef()[face.patch][face.index];
}

void dielectrics::addShares(Scalars& cellCharge) const
{
    for (const specialFace& face : faces_) {
        if (face.wall < 0 || face.own + face.across == 0) {
            continue;
        }
        const double perSide = chargeOf(face) * face.area / (face.own + face.across);
        cellCharge[face.cell] += face.own * perSide;
        if (face.other >= 0) {
            cellCharge[face.other] += face.across * perSide;
        }
    }
}

std::vector<scalarField> dielectrics::valuesAcross(const volScalarField& potential) const
{
    std::vector<scalarField> across(static_cast<std::size_t>(potential.boundaryField().size()));
    for (const specialFace& face : faces_) {
        scalarField& values = across[face.patch < 0 ? 0 : static_cast<std::size_t>(face.patch)];
        if (face.patch >= 0 && values.empty() && potential.boundaryField()[face.patch].coupled()) {
            values = potential.boundaryField()[face.patch].patchNeighbourField();
        }
    }
    return across;
}

double dielectrics::valueAt(const specialFace& face, const volScalarField& potential,
                            const std::vector<scalarField>& across) const
{
    const double there =
        face.patch < 0 ? potential[face.other] : across[static_cast<std::size_t>(face.patch)][face.index];
    return (face.own * potential[face.cell] + face.across * there) / (face.own + face.across);
}

tmp<surfaceScalarField> dielectrics::faceValues(const volScalarField& potential) const
{
    tmp<surfaceScalarField> values = linear<scalar>(potential.mesh()).interpolate(potential);
    surfaceScalarField& faces = values.ref();
    const std::vector<scalarField> across = valuesAcross(potential);
    for (const specialFace& face : faces_) {
        if (face.own + face.across == 0) {
            continue;  // the patch itself knows
        }
        const double charge = face.wall < 0 ? 0 : chargeOf(face);
        const double value = valueAt(face, potential, across) + charge / (permittivity_ * (face.own + face.across));
        (face.patch < 0 ? faces[face.index] : faces.boundaryFieldRef()[face.patch][face.index]) = value;
    }
    return values;
}

void dielectrics::updatePatches(volScalarField& potential) const
{
    forAll(potential.boundaryField(), patch)
    {
        auto* wall = dynamic_cast<insulatingWallFvPatchScalarField*>(&potential.boundaryFieldRef()[patch]);
        if (wall) {
            wall->setCharge(sigma_.boundaryField()[patch],
                            permittivity_ * relative_.boundaryField()[patch].patchInternalField());
        }
    }
}

void dielectrics::appendTo(BoundaryFaces& faces) const
{
    const fvMesh& mesh = relative_.mesh();
    const auto add = [&](label face, label cell, bool outOfOwner, Index row) {
        const vector normal = mesh.faceAreas()[face] / mag(mesh.faceAreas()[face]);
        faces.centre.row(row) = toEigen(mesh.faceCentres()[face]).transpose().array();
        faces.normal.row(row) = toEigen(outOfOwner ? normal : -normal).transpose().array();
        faces.area[row] = mag(mesh.faceAreas()[face]);
        scalar radius = 0;
        for (const label point : mesh.faces()[face]) {
            radius = max(radius, mag(mesh.points()[point] - mesh.faceCentres()[face]));
        }
        faces.radius[row] = radius;
        faces.value[row] = 0;
        faces.cell.push_back(static_cast<std::int32_t>(cell));
        faces.condition.push_back(FaceCondition::chargedWall);
    };
    Index rows = faces.size();
    Index row = rows;
    for (const specialFace& face : faces_) {
        rows += face.wall >= 0 && face.own + face.across > 0 ? (face.other >= 0 ? 2 : 1) : 0;
    }
    faces.centre.conservativeResize(rows, 3);
    faces.normal.conservativeResize(rows, 3);
    for (Scalars* values : {&faces.area, &faces.radius, &faces.value}) {
        values->conservativeResize(rows);
    }
    for (const specialFace& face : faces_) {
        if (face.wall < 0 || face.own + face.across == 0) {
            continue;
        }
        const label meshFace = face.patch < 0 ? face.index : mesh.boundary()[face.patch].start() + face.index;
        add(meshFace, face.cell, true, row++);
        if (face.other >= 0) {
            add(meshFace, face.other, false, row++);
        }
    }
}

void dielectrics::wallValues(const volScalarField& potential, const volScalarField& more, Scalars& values) const
{
    Index rows = 0;
    for (const specialFace& face : faces_) {
        rows += face.wall >= 0 && face.own + face.across > 0 ? (face.other >= 0 ? 2 : 1) : 0;
    }
    Index row = values.size() - rows;
    const std::vector<scalarField> across = valuesAcross(potential);
    const std::vector<scalarField> moreAcross = valuesAcross(more);
    for (const specialFace& face : faces_) {
        if (face.wall < 0 || face.own + face.across == 0) {
            continue;
        }
        const double value = valueAt(face, potential, across) + valueAt(face, more, moreAcross)
                             + chargeOf(face) / (permittivity_ * (face.own + face.across));
        values[row++] = value;
        if (face.other >= 0) {
            values[row++] = value;
        }
    }
}

Foam::face dielectrics::polygonOf(label owned) const
{
    const specialFace& face = faces_[owned_[static_cast<std::size_t>(owned)]];
    const fvMesh& mesh = relative_.mesh();
    return mesh.faces()[face.patch < 0 ? face.index : mesh.boundary()[face.patch].start() + face.index];
}

double dielectrics::surfaceCharge(label owned) const
{
    return chargeOf(faces_[owned_[static_cast<std::size_t>(owned)]]);
}

double dielectrics::faceValue(label owned, const surfaceScalarField& values) const
{
    const specialFace& face = faces_[owned_[static_cast<std::size_t>(owned)]];
    return face.patch < 0 ? values[face.index] : values.boundaryField()[face.patch][face.index];
}

void dielectrics::addCharge(const Scalars& charge)
{
    const fvMesh& mesh = relative_.mesh();
    scalarField gained(mesh.nFaces(), Zero);  // [C/m2]
    const auto meshFace = [&](const specialFace& face) {
        return face.patch < 0 ? face.index : mesh.boundary()[face.patch].start() + face.index;
    };
    for (std::size_t n = 0; n < owned_.size(); ++n) {
        const specialFace& face = faces_[owned_[n]];
        gained[meshFace(face)] = charge[static_cast<Index>(n)] / face.area;
    }
    syncTools::syncFaceList(mesh, gained, plusEqOp<scalar>());
    for (const specialFace& face : faces_) {
        if (face.wall >= 0) {
            chargeOf(face) += gained[meshFace(face)];
        }
    }
}

std::vector<double> dielectrics::totals() const
{
    scalarList sums(static_cast<label>(names_.size()), Zero);
    for (const std::size_t n : owned_) {
        sums[faces_[n].wall] += chargeOf(faces_[n]) * faces_[n].area;
    }
    for (scalar& total : sums) {
        reduce(total, sumOp<scalar>());
    }
    return {sums.begin(), sums.end()};
}

void dielectrics::write() const
{
    const unsigned int digits = IOstream::defaultPrecision(allDigits);
    surfaceScalarField now(IOobject(sigma_.name(), sigma_.time().timeName(), sigma_.mesh(), IOobject::NO_READ,
                                    IOobject::NO_WRITE, false),
                           sigma_);
    now.write();
    IOstream::defaultPrecision(digits);
}

}  // namespace him
