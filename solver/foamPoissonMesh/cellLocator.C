// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/cellLocator.H"

#include "foamPoissonMesh/conversions.H"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Bounding boxes and bins overlap by this share of the mesh size, so that round-off opens no gap between them.
constexpr double overlap = 1e-9;

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

    std::vector<bool> plane(static_cast<std::size_t>(mesh_.nFaces()));
    for (Foam::label face = 0; face < mesh_.nFaces(); ++face) {
        plane[static_cast<std::size_t>(face)] = isPlane(mesh_, face);
    }
    for (Foam::label cell = 0; cell < mesh_.nCells(); ++cell) {
        Box box;
        bool planeFaced = true;
        for (const Foam::label face : mesh_.cells()[cell]) {
            planeFaced = planeFaced && plane[static_cast<std::size_t>(face)];
            for (const Foam::label point : mesh_.faces()[face]) {
                box.extend(toEigen(mesh_.points()[point]));
            }
        }
        cellBox_.push_back(box.grownBy(margin));
        planeFaced_.push_back(planeFaced);
    }

    const double edge = std::cbrt(bounds_.size().prod() / mesh_.nCells());
    bins_ = (bounds_.size().array() / edge).ceil().cast<int>().max(1);
    binSize_ = bounds_.size().array() / bins_.cast<double>();

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
}

Eigen::Array3i cellLocator::binOf(const Vector3& point) const
{
    const Eigen::Array3i bin = ((point - bounds_.lower).array() / binSize_).floor().cast<int>();
    return bin.max(0).min(bins_ - 1);
}

std::size_t cellLocator::binIndex(int i, int j, int k) const
{
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(bins_.y()) + static_cast<std::size_t>(j))
               * static_cast<std::size_t>(bins_.z())
           + static_cast<std::size_t>(k);
}

bool cellLocator::insideFacePlanes(const Foam::point& point, Foam::label cell) const
{
    for (const Foam::label face : mesh_.cells()[cell]) {
        // The same product for both cells of a face, so that a point near it is inside at least one of them.
        const double outwards = (point - mesh_.faceCentres()[face]) & mesh_.faceAreas()[face];
        const bool outside = mesh_.faceOwner()[face] == cell ? outwards > 0 : outwards < 0;
        if (outside) {
            return false;
        }
    }
    return true;
}

Foam::label cellLocator::find(const Vector3& point) const
{
    if (!bounds_.contains(point) || binCells_.empty()) {
        return -1;
    }
    const Eigen::Array3i bin = binOf(point);
    const std::size_t index = binIndex(bin.x(), bin.y(), bin.z());
    const auto begin = binCells_.begin() + static_cast<long>(binStart_[index]);
    const auto end = binCells_.begin() + static_cast<long>(binStart_[index + 1]);
    const Foam::point position = toFoam(point);

    const auto holds = [&](Foam::label cell) {
        if (!cellBox_[static_cast<std::size_t>(cell)].contains(point)) {
            return false;
        }
        return planeFaced_[static_cast<std::size_t>(cell)]
                   ? insideFacePlanes(position, cell)
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

}  // namespace him
