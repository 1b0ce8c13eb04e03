// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/cellLocator.H"

#include "foamPoissonMesh/conversions.H"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Bounding boxes and bins overlap by this share of the mesh size, so that round-off opens no gap between them.
constexpr double overlap = 1e-9;

/// Coordinates of points are one when they are closer than this share of the mean size of cells.
constexpr double sameLayer = 1e-6;

/// Bins per cell up to which the layers of a mesh are its bins.
constexpr double mostBins = 2;

/// A point is well inside a cell when it is further from its faces than this share of the mesh size.
constexpr double wellApart = 1e-12;

/// The normal of a face across an axis has no more than this share of its length along the others: round-off of its corners.
constexpr double acrossAxis = 1e-14;

/// A face is plane when no point is further from its plane than this share of its size.
constexpr double planeness = 1e-9;

bool isPlane(const Foam::polyMesh& mesh, Foam::label face)
{
    const Foam::vector normal = mesh.faceAreas()[face] / Foam::mag(mesh.faceAreas()[face]);
    const double size = std::sqrt(Foam::mag(mesh.faceAreas()[face]));
    for (const Foam::label point : mesh.faces()[face]) {
        if (std::abs((mesh.points()[point] - mesh.faceCentres()[face]) & normal) > planeness * size) {
            return false;
        }
    }
    return true;
}

}  // namespace

cellLocator::cellLocator(const Foam::polyMesh& mesh) : mesh_(mesh)
{
    mesh_.tetBasePtIs();
    for (const Foam::point& point : mesh_.points()) {
        bounds_.extend(toEigen(point));
    }
    if (mesh_.nCells() == 0) {
        return;
    }
    const double margin = overlap * bounds_.size().maxCoeff();
    bounds_ = bounds_.grownBy(margin);

    planeStart_.push_back(0);
    for (Foam::label cell = 0; cell < mesh_.nCells(); ++cell) {
        Box box;
        for (const Foam::label face : mesh_.cells()[cell]) {
            for (const Foam::label point : mesh_.faces()[face]) {
                box.extend(toEigen(mesh_.points()[point]));
            }
        }
        cellBox_.push_back(box.grownBy(margin));
        listFacePlanes(cell);
        boxInside_.push_back(isBox(cell) ? box.grownBy(-wellApart * bounds_.size().maxCoeff()) : Box());
    }

    layBins();

    // Cells are visited twice in ascending order: first to count the entries of every bin, then to fill them in.
    const auto forEachBinOf = [this](const Box& box, auto&& visit) {
        const Eigen::Array3i first = binOf(box.lower);
        const Eigen::Array3i last = binOf(box.upper);
        for (int i = first.x(); i <= last.x(); ++i) {
            for (int j = first.y(); j <= last.y(); ++j) {
                for (int k = first.z(); k <= last.z(); ++k) {
                    visit(binIndex(i, j, k));
                }
            }
        }
    };
    binStart_.assign(static_cast<std::size_t>(bins_.prod()) + 1, 0);
    for (const Box& box : cellBox_) {
        forEachBinOf(box, [this](std::size_t bin) { ++binStart_[bin + 1]; });
    }
    for (std::size_t bin = 1; bin < binStart_.size(); ++bin) {
        binStart_[bin] += binStart_[bin - 1];
    }
    binCells_.resize(binStart_.back());
    std::vector<std::size_t> next(binStart_.begin(), binStart_.end() - 1);
    for (std::size_t cell = 0; cell < cellBox_.size(); ++cell) {
        forEachBinOf(cellBox_[cell], [&](std::size_t bin) { binCells_[next[bin]++] = static_cast<Foam::label>(cell); });
    }
    middleCell_.reserve(static_cast<std::size_t>(bins_.prod()));
    for (int i = 0; i < bins_.x(); ++i) {
        for (int j = 0; j < bins_.y(); ++j) {
            for (int k = 0; k < bins_.z(); ++k) {
                const Vector3 middle(axis_[0].middle(i), axis_[1].middle(j), axis_[2].middle(k));
                const Foam::label cell = search(middle, binIndex(i, j, k));
                const bool planeFaced =
                    cell >= 0
                    && planeStart_[static_cast<std::size_t>(cell)] < planeStart_[static_cast<std::size_t>(cell) + 1];
                middleCell_.push_back(planeFaced ? cell : -1);
            }
        }
    }
}

/// In a structured mesh the bins are its cells. Elsewhere they are about as many and lie dense where its points do.
void cellLocator::layBins()
{
    const double edge = std::cbrt(bounds_.size().prod() / mesh_.nCells());
    double layers = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double> coordinates;
        coordinates.reserve(static_cast<std::size_t>(mesh_.nPoints()));
        for (const Foam::point& point : mesh_.points()) {
            coordinates.push_back(point[static_cast<Foam::direction>(axis)]);
        }
        axis_[axis] = binAxis(std::move(coordinates), sameLayer * edge);
        layers *= axis_[axis].layers();
    }
    for (int axis = 0; axis < 3; ++axis) {
        binAxis& bins = axis_[static_cast<std::size_t>(axis)];
        if (layers > mostBins * mesh_.nCells()) {
            bins.reduceTo(std::max(1, static_cast<int>(std::ceil(bounds_.size()[axis] / edge))));
        }
        bins.finish();
        bins_[axis] = bins.bins();
    }
}

/// Appends the planes of the cell's faces, or nothing when one of them is not plane.
void cellLocator::listFacePlanes(Foam::label cell)
{
    const Foam::cell& faces = mesh_.cells()[cell];
    if (std::all_of(faces.begin(), faces.end(), [this](Foam::label face) { return isPlane(mesh_, face); })) {
        const double size = bounds_.size().maxCoeff();
        for (const Foam::label face : faces) {
            const Vector3 normal = toEigen(mesh_.faceAreas()[face]);
            planes_.push_back({normal, normal.dot(toEigen(mesh_.faceCentres()[face])), wellApart * size * normal.norm(),
                               mesh_.faceOwner()[face] == cell});
        }
    }
    planeStart_.push_back(planes_.size());
}

/// Whether the cell's faces are plane and across the axes.
bool cellLocator::isBox(Foam::label cell) const
{
    const auto c = static_cast<std::size_t>(cell);
    const auto across = [](const Plane& plane) {
        return plane.normal.cwiseAbs().maxCoeff() > (1 - acrossAxis) * plane.normal.lpNorm<1>();
    };
    return planeStart_[c + 1] - planeStart_[c] == 6
           && std::all_of(planes_.begin() + static_cast<long>(planeStart_[c]), planes_.end(), across);
}

Eigen::Array3i cellLocator::binOf(const Vector3& point) const
{
    return {axis_[0].bin(point[0]), axis_[1].bin(point[1]), axis_[2].bin(point[2])};
}

std::size_t cellLocator::binIndex(int i, int j, int k) const
{
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(bins_.y()) + static_cast<std::size_t>(j))
               * static_cast<std::size_t>(bins_.z())
           + static_cast<std::size_t>(k);
}

std::size_t cellLocator::binAt(const Vector3& point) const
{
    const Eigen::Array3i bin = binOf(point);
    return binIndex(bin.x(), bin.y(), bin.z());
}

bool cellLocator::insideFacePlanes(const Vector3& point, Foam::label cell) const
{
    const auto c = static_cast<std::size_t>(cell);
    for (std::size_t n = planeStart_[c]; n < planeStart_[c + 1]; ++n) {
        const Plane& plane = planes_[n];
        // The same number for both cells of a face, so that a point near it is inside at least one of them.
        const double along = plane.normal.dot(point) - plane.offset;
        if (plane.outwards ? along > 0 : along < 0) {
            return false;
        }
    }
    return true;
}

bool cellLocator::wellInside(const Vector3& point, Foam::label cell) const
{
    const auto c = static_cast<std::size_t>(cell);
    bool inside = true;
    for (std::size_t n = planeStart_[c]; n < planeStart_[c + 1]; ++n) {
        const Plane& plane = planes_[n];
        const double along = plane.normal.dot(point) - plane.offset;
        inside = inside && (plane.outwards ? along : -along) < -plane.margin;
    }
    return inside;
}

Foam::label cellLocator::search(const Vector3& point, std::size_t bin) const
{
    const auto begin = binCells_.begin() + static_cast<long>(binStart_[bin]);
    const auto end = binCells_.begin() + static_cast<long>(binStart_[bin + 1]);
    const Foam::point position = toFoam(point);

    const auto holds = [&](Foam::label cell) {
        const auto c = static_cast<std::size_t>(cell);
        if (!cellBox_[c].contains(point)) {
            return false;
        }
        return planeStart_[c] < planeStart_[c + 1] ? insideFacePlanes(point, cell)
                                                   : mesh_.pointInCell(position, cell, Foam::polyMesh::CELL_TETS);
    };
    const auto nearlyHolds = [&](Foam::label cell) {
        return cellBox_[static_cast<std::size_t>(cell)].contains(point)
               && mesh_.pointInCell(position, cell, Foam::polyMesh::CELL_TETS);
    };
    auto found = std::find_if(begin, end, holds);
    if (found == end) {
        found = std::find_if(begin, end, nearlyHolds);
    }
    return found == end ? -1 : *found;
}

Foam::label cellLocator::find(const Vector3& point) const
{
    if (!bounds_.contains(point) || binCells_.empty()) {
        return -1;
    }
    const std::size_t bin = binAt(point);
    const Foam::label middle = middleCell_[bin];
    if (middle >= 0 && (boxInside_[static_cast<std::size_t>(middle)].contains(point) || wellInside(point, middle))) {
        return middle;
    }
    return search(point, bin);
}

}  // namespace him
