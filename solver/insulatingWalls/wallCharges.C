// SPDX-License-Identifier: GPL-3.0-or-later
#include "insulatingWalls/wallCharges.H"

#include "foamPoissonMesh/conversions.H"

#include "dem_coupling/exchange/mesh_locator.hpp"
#include "dem_coupling/exchange/wall_offsets.hpp"

#include "OSspecific.H"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace him {

namespace {

/// Default of wallDistance: this share of the edge of the smallest wall face.
constexpr double shareOfFace = 0.1;

std::vector<WallFacePolygon> polygonsOf(const dielectrics& matter)
{
    std::vector<WallFacePolygon> polygons;
    for (Foam::label n = 0; n < matter.ownedFaces(); ++n) {
        WallFacePolygon polygon;
        polygon.wall = matter.wallOf(n);
        for (const Foam::label point : matter.polygonOf(n)) {
            polygon.corners.push_back(toEigen(matter.mesh().points()[point]));
        }
        polygons.push_back(polygon);
    }
    return polygons;
}

double defaultReach(const dielectrics& matter)
{
    Foam::scalar smallest = Foam::VGREAT;
    for (Foam::label n = 0; n < matter.ownedFaces(); ++n) {
        smallest = Foam::min(smallest, matter.areaOf(n));
    }
    return shareOfFace * std::sqrt(Foam::returnReduce(smallest, Foam::minOp<Foam::scalar>()));
}

std::string shownPoint(const Vector3& p)
{
    return "(" + shown(p.x()) + " " + shown(p.y()) + " " + shown(p.z()) + ") m";
}

}  // namespace

bool wallCharges::isInsulating(const std::string& target, const dielectrics* matter)
{
    if (!matter) {
        return false;
    }
    const std::vector<std::string>& names = matter->wallNames();
    return !names.empty()
           && (target == insulatingTarget || std::find(names.begin(), names.end(), target) != names.end());
}

wallCharges::wallCharges(dielectrics& matter, double reach, MPI_Comm communicator)
    : matter_(matter), communicator_(communicator), faces_(polygonsOf(matter), reach, communicator)
{
}

std::unique_ptr<wallCharges> wallCharges::create(const caseSettings& settings, const DemPort& dem,
                                                 foamPoissonMesh& mesh, MPI_Comm communicator, Complaints& complaints)
{
    dielectrics* matter = mesh.matter();
    const bool any = std::any_of(settings.walls.begin(), settings.walls.end(),
                                 [&](const auto& wall) { return isInsulating(wall.second, matter); });
    if (!any) {
        return nullptr;
    }
    const double reach = settings.wallDistance > 0 ? settings.wallDistance : defaultReach(*matter);
    std::unique_ptr<wallCharges> made(new wallCharges(*matter, reach, communicator));
    for (std::size_t n = 0; n < dem.walls().size(); ++n) {
        const DemWall& wall = dem.walls()[n];
        const auto entry = std::find_if(settings.walls.begin(), settings.walls.end(),
                                        [&](const auto& candidate) { return candidate.first == wall.name; });
        int number = none;
        if (entry != settings.walls.end() && isInsulating(entry->second, matter)) {
            const auto& names = matter->wallNames();
            const auto named = std::find(names.begin(), names.end(), entry->second);
            number = named == names.end() ? WallFaces::anyWall : static_cast<int>(named - names.begin());
            if (made->checkPlace(wall, number, pointsOfAllRanks(dem.wallPoints(n), communicator), mesh.globalBounds(),
                                 complaints)) {
                made->checkCover(dem, n, number, mesh, complaints);
            }
        }
        made->wallOf_.push_back(number);
        made->demNames_.push_back(wall.name);
    }
    return made;
}

bool wallCharges::checkPlace(const DemWall& wall, int insulatingWall, const std::vector<Vector3>& points,
                             const Box& mesh, Complaints& complaints) const
{
    double worst = 0;
    bool seen = false;
    if (wall.primitive) {
        // The faces that look like this wall: parallel to the plane (the nearest of them), or around the cylinder (all).
        const bool plane = wall.image.shape == ImageWall::Shape::plane;
        double nearest = std::numeric_limits<double>::infinity();
        for (Index face = 0; face < static_cast<Index>(faces_.all().size()); ++face) {
            if (insulatingWall != WallFaces::anyWall
                && faces_.all()[static_cast<std::size_t>(face)].wall != insulatingWall) {
                continue;
            }
            const Vector3 offset = faces_.centreOf(face) - wall.image.point;
            Vector3 across = wall.image.normal;
            double away = std::abs(offset.dot(across));
            if (!plane) {
                const Vector3 radial = offset - offset.dot(wall.image.normal) * wall.image.normal;
                across = radial.normalized();
                away = std::abs(radial.norm() - wall.image.radius);
            }
            if (std::abs(across.dot(faces_.normalOf(face))) < alongWall) {
                continue;
            }
            seen = true;
            nearest = std::min(nearest, away);
            worst = std::max(worst, away);
        }
        worst = plane ? nearest : worst;
    } else {
        for (const Vector3& point : pointsOfFacets(points, mesh)) {
            seen = true;
            worst = std::max(
                worst, faces_.find(point, insulatingWall).face >= 0 ? 0.0 : faces_.distanceTo(point, insulatingWall));
        }
    }
    if (!seen || worst > faces_.reach()) {
        complaints.add(
            "constant/couplingProperties: walls: " + wall.name,
            "the DEM wall lies off the insulating wall of the mesh"
                + (seen ? " by " + shown(worst) + " m" : std::string(" altogether: no face looks its way"))
                + ", more than wallDistance, " + shown(faces_.reach())
                + " m, so its charge would have no face to stay on. Move one of them, or raise wallDistance.");
        return false;
    }
    return true;
}

void wallCharges::checkCover(const DemPort& dem, std::size_t demWall, int insulatingWall, const foamPoissonMesh& mesh,
                             Complaints& complaints) const
{
    const std::vector<DemWall>& walls = dem.walls();
    // Behind a mesh wall of the DEM scene particles may not come, but nothing here tells where behind is.
    if (!std::all_of(walls.begin(), walls.end(), [](const DemWall& wall) { return wall.primitive; })) {
        return;
    }
    Vector3 middle = Vector3::Zero();
    double faces = 0;
    for (Index n = 0; n < static_cast<Index>(faces_.all().size()); ++n) {
        const WallFacePolygon& face = faces_.all()[static_cast<std::size_t>(n)];
        const bool own = insulatingWall == WallFaces::anyWall || face.wall == insulatingWall;
        if (own && distanceAlong(walls[demWall].image, face) <= faces_.reach()) {
            middle += faces_.centreOf(n);
            faces += 1;
        }
    }
    const std::vector<Vector3> points = reachablePoints(walls, demWall, middle / faces, dem.box());
    // A little to both sides, because faces at the edge of the mesh may lie on either side of the DEM wall.
    Points beside(2 * static_cast<Index>(points.size()), 3);
    for (std::size_t n = 0; n < points.size(); ++n) {
        const ImageWall& wall = walls[demWall].image;
        const Vector3 offset = points[n] - wall.point;
        const Vector3 across = wall.shape == ImageWall::Shape::plane
                                   ? wall.normal
                                   : Vector3((offset - offset.dot(wall.normal) * wall.normal).normalized());
        for (const int side : {0, 1}) {
            beside.row(2 * static_cast<Index>(n) + side) =
                (points[n] + (side == 0 ? 2.0 : -2.0) * faces_.reach() * across).transpose().array();
        }
    }
    MeshLocator locator(mesh, communicator_, dem.box(), dem.periodic());
    locator.locate(beside);
    double looked = 0;
    double bare = 0;
    Vector3 first = Vector3::Zero();
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!locator.inMesh(2 * static_cast<Index>(n)) && !locator.inMesh(2 * static_cast<Index>(n) + 1)) {
            continue;
        }
        looked += 1;
        if (faces_.find(points[n], insulatingWall).face < 0) {
            first = bare == 0 ? points[n] : first;
            bare += 1;
        }
    }
    if (bare > 0) {
        complaints.add("constant/couplingProperties: walls: " + walls[demWall].name,
                       "particles can touch the DEM wall where the insulating wall of the mesh has no face: "
                           + shown(100 * bare / looked, 2) + " % of it is bare, as at " + shownPoint(first)
                           + ", and a contact there would stop the run. Let the wall's faces cover all of it, or shut "
                             "particles out.");
    }
}

void wallCharges::add(const std::vector<WallCharge>& charges)
{
    at_.clear();
    charges_.clear();
    std::string lost;
    for (const WallCharge& charge : charges) {
        const auto demWall = static_cast<std::size_t>(charge.wall);
        const WallFaces::Place place = faces_.find(charge.point, wallOf_[demWall]);
        if (place.face < 0) {
            if (lost.empty()) {
                lost = "a contact at " + shownPoint(charge.point) + " with the insulating DEM wall "
                       + demNames_[demWall] + " is at no face of the mesh that could keep its charge; the nearest is "
                       + shown(faces_.distanceTo(charge.point, wallOf_[demWall])) + " m away, wallDistance is "
                       + shown(faces_.reach())
                       + " m. Let the mesh wall follow the DEM wall, or raise wallDistance in "
                         "constant/couplingProperties.";
            }
            continue;
        }
        at_.push_back(place.face);
        charges_.push_back(charge.charge);
    }
    int fault = lost.empty() ? 0 : 1;
    MPI_Allreduce(MPI_IN_PLACE, &fault, 1, MPI_INT, MPI_MAX, communicator_);
    if (fault) {
        throwTogether(communicator_, lost.empty() ? nothingToSay : Foam::Pstream::myProcNo(), lost);
    }
    faces_.collect(at_, charges_, own_);
    matter_.addCharge(own_);
}

double wallCharges::total() const
{
    double sum = 0;
    for (const double wall : matter_.totals()) {
        sum += wall;
    }
    return sum;
}

Scalars wallCharges::faceCharges() const
{
    Scalars charges(matter_.ownedFaces());
    for (Foam::label n = 0; n < matter_.ownedFaces(); ++n) {
        charges[n] = matter_.surfaceCharge(n) * matter_.areaOf(n);
    }
    return charges;
}

void wallCharges::mark()
{
    marked_ = faceCharges();
}

double wallCharges::activity() const
{
    return Foam::returnReduce((faceCharges() - marked_).abs().sum(), Foam::sumOp<double>());
}

void wallCharges::continueSinceMark(double times, double perActivity)
{
    const Scalars gain = faceCharges() - marked_;
    matter_.addCharge(times * gain + perActivity * gain.abs());
}

void wallCharges::write(const Foam::Time& runTime)
{
    matter_.write();
    std::vector<double> mine;
    for (Foam::label n = 0; n < matter_.ownedFaces(); ++n) {
        mine.push_back(matter_.surfaceCharge(n));
    }
    Foam::List<Foam::scalarList> all(Foam::Pstream::nProcs());
    all[Foam::Pstream::myProcNo()] = Foam::scalarList(mine.begin(), mine.end());
    Foam::Pstream::gatherList(all);
    if (!Foam::Pstream::master()) {
        return;
    }
    const Foam::fileName folder = runTime.globalPath() / "postProcessing" / "wallCharge";
    Foam::mkDir(folder);
    const std::string name = runTime.timeName() + ".vtp";
    std::ofstream file(folder / name);
    file.precision(17);
    std::size_t corners = 0;
    for (const WallFacePolygon& face : faces_.all()) {
        corners += face.corners.size();
    }
    const auto array = [&file](const char* type, const char* title, int components) {
        file << "<DataArray type=\"" << type << "\" Name=\"" << title << "\" NumberOfComponents=\"" << components
             << "\" format=\"ascii\">\n";
    };
    file << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"LittleEndian\">\n<PolyData>\n"
         << "<Piece NumberOfPoints=\"" << corners << "\" NumberOfPolys=\"" << faces_.all().size() << "\">\n<Points>\n";
    array("Float64", "position", 3);
    for (const WallFacePolygon& face : faces_.all()) {
        for (const Vector3& corner : face.corners) {
            file << corner[0] << ' ' << corner[1] << ' ' << corner[2] << '\n';
        }
    }
    file << "</DataArray>\n</Points>\n<CellData Scalars=\"surfaceCharge\">\n";
    array("Float64", "surfaceCharge", 1);
    for (const Foam::scalarList& values : all) {
        for (const Foam::scalar value : values) {
            file << value << '\n';
        }
    }
    file << "</DataArray>\n";
    array("Int32", "wall", 1);
    for (const WallFacePolygon& face : faces_.all()) {
        file << face.wall << '\n';
    }
    file << "</DataArray>\n</CellData>\n<Polys>\n";
    array("Int64", "connectivity", 1);
    for (std::size_t n = 0; n < corners; ++n) {
        file << n << '\n';
    }
    file << "</DataArray>\n";
    array("Int64", "offsets", 1);
    std::size_t end = 0;
    for (const WallFacePolygon& face : faces_.all()) {
        file << (end += face.corners.size()) << '\n';
    }
    file << "</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";

    series_.add(folder, "wallCharge", name, runTime.value());
}

}  // namespace him
