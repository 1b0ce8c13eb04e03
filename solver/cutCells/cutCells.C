// SPDX-License-Identifier: GPL-3.0-or-later
/*---------------------------------------------------------------------------*\
Application
    cutCells

Description
    Cuts a mesh into slabs for the ranks of a parallel run, at given places or
    so that every slab holds as many particles, and writes
    constant[/<region>]/cellDecomposition for decomposePar's method `manual`.
    The same places go to the DEM script's cut_domain, so that most particles
    are on one rank with their cells.

Usage
    cutCells -axis x|y|z (-at "(PLACE ...)" | -parts N)
        [-zone NAME [-layers N]] [-region NAME] [-time T]

    -parts N reads the cloud `particles` of the time -time (default: the last).
    With -zone only the cells of that zone, and of -layers layers around it,
    are cut at the places; the others are dealt out along the axis so that all
    slabs have as many cells.

SourceFiles
    cutCells.C
\*---------------------------------------------------------------------------*/
#include "dem_coupling/complaints.hpp"
#include "parallel/session.H"
#include "settings/electricRegion.H"

#include "OSspecific.H"
#include "Time.H"
#include "argList.H"
#include "labelIOList.H"
#include "passiveParticleCloud.H"
#include "polyMesh.H"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <vector>

namespace him {

namespace {

struct cutting {
    Foam::direction axis = 0;
    std::vector<double> places;  ///< [m], ascending
    Foam::label parts() const { return static_cast<Foam::label>(places.size()) + 1; }
};

Foam::direction readAxis(const Foam::argList& args, Complaints& complaints)
{
    const std::string axis = args.lookupOrDefault<Foam::word>("axis", "");
    const auto found = axis.size() == 1 ? std::string("xyz").find(axis) : std::string::npos;
    if (found == std::string::npos) {
        complaints.add("-axis", "expected x, y or z" + (axis.empty() ? std::string(".") : ", found " + axis + "."));
        return 0;
    }
    return static_cast<Foam::direction>(found);
}

std::vector<double> givenPlaces(const Foam::argList& args, Complaints& complaints)
{
    const Foam::scalarList list = args.lookupOrDefault<Foam::scalarList>("at", Foam::scalarList());
    const std::vector<double> places(list.begin(), list.end());
    if (places.empty() || std::adjacent_find(places.begin(), places.end(), std::greater_equal<>()) != places.end()) {
        complaints.add("-at", "expected one or more ascending places [m], as -at \"(0.01 0.02)\".");
    }
    return places;
}

/// Coordinates of all particles of the case's cloud at the present time, in ascending order; empty when there is no cloud.
std::vector<double> sortedParticles(const Foam::Time& time, Foam::direction axis)
{
    std::vector<double> along;
    for (const Foam::word& region : {Foam::word("electric"), Foam::polyMesh::defaultRegion}) {
        if (!Foam::isDir(ofRegion(time.timePath(), region) / "lagrangian" / "particles")) {
            continue;
        }
        const Foam::polyMesh mesh(Foam::IOobject(region, time.timeName(), time, Foam::IOobject::MUST_READ));
        mesh.tetBasePtIs();
        const Foam::passiveParticleCloud cloud(mesh, "particles");
        for (const Foam::passiveParticle& particle : cloud) {
            along.push_back(particle.position()[axis]);
        }
        break;
    }
    std::sort(along.begin(), along.end());
    return along;
}

/// Places between particles, with as many of them in every part.
std::vector<double> balancedPlaces(const Foam::argList& args, const Foam::Time& time, Foam::direction axis,
                                   Complaints& complaints)
{
    const auto parts = args.lookupOrDefault<Foam::label>("parts", 0);
    if (parts < 2) {
        complaints.add("-parts", "expected a number of at least 2.");
        return {};
    }
    const std::vector<double> along = sortedParticles(time, axis);
    if (along.size() < static_cast<std::size_t>(parts)) {
        complaints.add("-time", "the cloud `particles` of the time " + time.timeName() + " has "
                                    + std::to_string(along.size()) + " particles, too few for " + std::to_string(parts)
                                    + " parts. Give the places of the cuts with -at.");
        return {};
    }
    std::vector<double> places;
    for (Foam::label part = 1; part < parts; ++part) {
        const std::size_t above = along.size() * static_cast<std::size_t>(part) / static_cast<std::size_t>(parts);
        places.push_back(0.5 * (along[above - 1] + along[above]));
    }
    return places;
}

Foam::label partAt(const cutting& cuts, double place)
{
    return static_cast<Foam::label>(std::upper_bound(cuts.places.begin(), cuts.places.end(), place)
                                    - cuts.places.begin());
}

/// Gives cells, in their order along the axis, to the parts that have room left.
void dealOut(std::vector<Foam::label> cells, const Foam::polyMesh& mesh, const cutting& cuts, Foam::labelList& part)
{
    const Foam::pointField& centres = mesh.cellCentres();
    std::stable_sort(cells.begin(), cells.end(),
                     [&](Foam::label a, Foam::label b) { return centres[a][cuts.axis] < centres[b][cuts.axis]; });
    std::vector<Foam::label> room(static_cast<std::size_t>(cuts.parts()));
    for (std::size_t n = 0; n < room.size(); ++n) {
        const auto end = static_cast<Foam::label>(n) + 1;
        room[n] = mesh.nCells() * end / cuts.parts() - mesh.nCells() * (end - 1) / cuts.parts();
    }
    for (const Foam::label taken : part) {
        if (taken >= 0) {
            --room[static_cast<std::size_t>(taken)];
        }
    }
    // A part that has too many already gets none; the others make up for it.
    Foam::label wanted = 0;
    for (Foam::label& free : room) {
        free = std::max(free, Foam::label(0));
        wanted += free;
    }
    Foam::label given = 0, before = 0;
    std::size_t to = 0;
    for (const Foam::label cell : cells) {
        while (to + 1 < room.size() && given * wanted >= (before + room[to]) * static_cast<Foam::label>(cells.size())) {
            before += room[to++];
        }
        part[cell] = static_cast<Foam::label>(to);
        ++given;
    }
}

/// The cells and so many layers around them, by common faces.
std::vector<Foam::label> withLayers(const Foam::polyMesh& mesh, const Foam::labelUList& cells, Foam::label layers)
{
    std::vector<Foam::label> all(cells.begin(), cells.end());
    std::vector<bool> taken(static_cast<std::size_t>(mesh.nCells()), false);
    for (const Foam::label cell : all) {
        taken[static_cast<std::size_t>(cell)] = true;
    }
    std::size_t first = 0;
    for (Foam::label layer = 0; layer < layers; ++layer) {
        const std::size_t end = all.size();
        for (; first < end; ++first) {
            for (const Foam::label neighbour : mesh.cellCells()[all[first]]) {
                if (!taken[static_cast<std::size_t>(neighbour)]) {
                    taken[static_cast<std::size_t>(neighbour)] = true;
                    all.push_back(neighbour);
                }
            }
        }
    }
    return all;
}

/// Where -zone and -layers want a mesh cut.
struct cutRegion {
    Foam::word zone;  ///< empty: everywhere
    Foam::label layers = 0;
};

cutRegion readCutRegion(const Foam::argList& args, Complaints& complaints)
{
    cutRegion region{args.lookupOrDefault<Foam::word>("zone", Foam::word::null), 0};
    if (args.found("layers")) {
        region.layers = args.get<Foam::label>("layers");
        if (region.zone.empty() || region.layers < 0) {
            complaints.add("-layers", "expected a whole number of layers around the cells of -zone, 0 or more.");
        }
    }
    return region;
}

Foam::labelList partsOfCells(const Foam::polyMesh& mesh, const cutting& cuts, const cutRegion& region,
                             Complaints& complaints)
{
    Foam::labelList part(mesh.nCells(), -1);
    const auto cut = [&](Foam::label cell) { part[cell] = partAt(cuts, mesh.cellCentres()[cell][cuts.axis]); };
    if (region.zone.empty()) {
        for (Foam::label cell = 0; cell < mesh.nCells(); ++cell) {
            cut(cell);
        }
        return part;
    }
    const Foam::word& zoneName = region.zone;
    const Foam::label zone = mesh.cellZones().findZoneID(zoneName);
    if (zone < 0) {
        std::ostringstream names;
        for (const Foam::word& known : mesh.cellZones().names()) {
            names << ' ' << known;
        }
        complaints.add("-zone", "the mesh has no cell zone " + zoneName
                                    + (names.str().empty() ? ", nor any other." : ". It has:" + names.str() + "."));
        return part;
    }
    for (const Foam::label cell : withLayers(mesh, mesh.cellZones()[zone], region.layers)) {
        cut(cell);
    }
    std::vector<Foam::label> others;
    for (Foam::label cell = 0; cell < mesh.nCells(); ++cell) {
        if (part[cell] < 0) {
            others.push_back(cell);
        }
    }
    dealOut(others, mesh, cuts, part);
    return part;
}

void run(const Foam::argList& args, MPI_Comm communicator)
{
    Complaints complaints;
    Foam::Time time(Foam::Time::controlDictName, args);
    const Foam::instantList times = time.times();
    if (args.found("time")) {
        time.setTime(time.findClosestTime(args.get<Foam::scalar>("time")), 0);
    } else {
        time.setTime(times.last(), 0);
    }
    cutting cuts;
    cuts.axis = readAxis(args, complaints);
    if (args.found("at") == args.found("parts")) {
        complaints.add("-at, -parts", "expected one of them.");
    } else {
        cuts.places =
            args.found("at") ? givenPlaces(args, complaints) : balancedPlaces(args, time, cuts.axis, complaints);
    }
    const cutRegion where = readCutRegion(args, complaints);
    stopOnComplaints(complaints, "Options", communicator);

    const Foam::word region = args.lookupOrDefault<Foam::word>("region", Foam::polyMesh::defaultRegion);
    const Foam::polyMesh mesh(Foam::IOobject(region, time.timeName(), time, Foam::IOobject::MUST_READ));
    const Foam::labelList part = partsOfCells(mesh, cuts, where, complaints);
    stopOnComplaints(complaints, "Options", communicator);

    const Foam::labelIOList written(Foam::IOobject("cellDecomposition", mesh.facesInstance(), mesh,
                                                   Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false),
                                    part);
    if (!written.write()) {
        throw std::runtime_error("the file " + written.objectPath() + " cannot be written.");
    }
    std::vector<Foam::label> cells(static_cast<std::size_t>(cuts.parts()));
    for (const Foam::label n : part) {
        ++cells[static_cast<std::size_t>(n)];
    }
    Foam::Info << "Cells of each part:";
    for (const Foam::label count : cells) {
        Foam::Info << ' ' << count;
    }
    Foam::Info << "\nIn the DEM script, before `processors`:\ncut_domain "
               << "xyz"[cuts.axis];
    for (const double place : cuts.places) {
        std::ostringstream text;
        text.precision(6);
        text << ' ' << place;
        Foam::Info << text.str().c_str();
    }
    Foam::Info << "\n\nEnd\n" << Foam::endl;
}

}  // namespace

}  // namespace him

int main(int argc, char* argv[])
{
    Foam::argList::addNote("Cuts a mesh into slabs for decomposePar's method manual, at given places or by particles.");
    Foam::argList::addOption("axis", "x|y|z", "Across the slabs");
    Foam::argList::addOption("at", "\"(PLACE ...)\"", "Where to cut [m]");
    Foam::argList::addOption("parts", "N", "In place of -at: N slabs with as many particles in each");
    Foam::argList::addOption("zone", "name", "Cut these cells only; deal out the others evenly");
    Foam::argList::addOption("layers", "N", "Cut as many layers of cells around the zone as well (default: 0)");
    Foam::argList::addOption("region", "name", "Mesh to cut");
    Foam::argList::addOption("time", "T", "Time of the particles for -parts (default: the last)");
    Foam::argList::noParallel();
    Foam::argList::noFunctionObjects();
    return him::runSession(argc, argv, him::run);
}
