// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace him {

namespace {

/// Faces whose planes differ by less than this share of the face size, and whose normals by less than this, are coplanar.
constexpr double coplanar = 1e-6;
/// Two planes whose normals have a smaller product than this are perpendicular: their images mirror in both.
constexpr double perpendicular = 1e-6;
/// Planes that turn by less than 60 degrees are one curved wall, of which the nearest facet serves.
constexpr double sameWall = 0.5;
/// A cell centre counts as beyond a plane when it is farther out than this share of the cell size.
constexpr double beyond = 1e-3;

}  // namespace

bool Surroundings::reaches(Index cell) const
{
    auto after = std::upper_bound(cells.begin(), cells.end(), cell,
                                  [](Index value, const RowRange& range) { return value < range.begin; });
    return after != cells.begin() && cell < std::prev(after)->end;
}

SurroundingsTable::SurroundingsTable(const LocalMesh& mesh, double cloudRadius)
    : mesh_(mesh),
      radius_(cloudRadius),
      table_(static_cast<std::size_t>(mesh.cells())),
      mark_(static_cast<std::size_t>(mesh.cells()), 0)
{
    findPlanes();
    findExactFaces();
}

void SurroundingsTable::findPlanes()
{
    // Faces are sorted by their rounded normal; among those of one normal, planes are told apart by their offset.
    std::map<std::array<std::int64_t, 4>, std::vector<std::int32_t>> byNormal;
    const BoundaryFaces& faces = mesh_.boundary;
    planeOfFace_.assign(static_cast<std::size_t>(faces.size()), -1);
    constexpr double cells = 1e4;  // rounding of a normal's components
    for (Index face = 0; face < faces.size(); ++face) {
        const Vector3 normal = faces.normal.row(face).matrix().transpose();
        const Vector3 centre = faces.centre.row(face).matrix().transpose();
        const double sign = faces.condition[static_cast<std::size_t>(face)] == FaceCondition::conductor ? -1.0 : 1.0;
        std::int32_t found = -1;
        // A normal near the edge of a rounding bin may stand in the next one.
        for (int shift = 0; shift < 27 && found < 0; ++shift) {
            const std::array<std::int64_t, 4> key{std::llround(normal[0] * cells) + shift % 3 - 1,
                                                  std::llround(normal[1] * cells) + (shift / 3) % 3 - 1,
                                                  std::llround(normal[2] * cells) + shift / 9 - 1, sign < 0 ? 0 : 1};
            const auto list = byNormal.find(key);
            if (list == byNormal.end()) {
                continue;
            }
            for (const std::int32_t candidate : list->second) {
                const WallPlane& plane = planes_[static_cast<std::size_t>(candidate)];
                if (std::abs(plane.distance(centre)) <= coplanar * std::sqrt(faces.area[face])
                    && (plane.normal - normal).norm() <= coplanar) {
                    found = candidate;
                    break;
                }
            }
        }
        if (found < 0) {
            found = static_cast<std::int32_t>(planes_.size());
            planes_.push_back({centre, normal, sign});
            byNormal[{std::llround(normal[0] * cells), std::llround(normal[1] * cells), std::llround(normal[2] * cells),
                      sign < 0 ? 0 : 1}]
                .push_back(found);
        }
        planeOfFace_[static_cast<std::size_t>(face)] = found;
    }

    outerFree_.resize(planes_.size());
    for (std::size_t n = 0; n < planes_.size(); ++n) {
        bool free = true;
        for (Index cell = 0; cell < mesh_.cells() && free; ++cell) {
            free = planes_[n].distance(mesh_.centreOf(cell)) > -beyond * mesh_.radius[cell];
        }
        outerFree_[n] = free;
        convex_ = convex_ && free;
    }
}

void SurroundingsTable::findExactFaces()
{
    // Images of all charges cancel in a face when the planes that charges in its reach are mirrored in are perpendicular to
    // its own and to each other: then all image sets are symmetric about it. Planes farther apart than 2 R never mirror the
    // same charge.
    const BoundaryFaces& faces = mesh_.boundary;
    exact_.assign(static_cast<std::size_t>(faces.size()), false);
    std::vector<Box> boxes(planes_.size());
    for (Index face = 0; face < faces.size(); ++face) {
        const Vector3 centre = faces.centre.row(face).matrix().transpose();
        const Vector3 normal = faces.normal.row(face).matrix().transpose();
        const Vector3 extent = faces.radius[face] * (1 - normal.array().square()).max(0).sqrt().matrix();
        Box& box = boxes[static_cast<std::size_t>(planeOfFace_[static_cast<std::size_t>(face)])];
        box.extend(centre - extent);
        box.extend(centre + extent);
    }
    const auto gapTo = [&](std::size_t plane, const Vector3& point) {
        return std::sqrt(boxes[plane].squaredDistance(point));
    };
    const auto gap = [&](std::size_t a, std::size_t b) {
        return (boxes[a].lower - boxes[b].upper).cwiseMax(boxes[b].lower - boxes[a].upper).cwiseMax(0).norm();
    };
    const auto square = [&](std::size_t a, std::size_t b) {
        return std::abs(planes_[a].normal.dot(planes_[b].normal)) < perpendicular;
    };
    const double reach = 2 * radius_ * (1 - 1e-9);
    std::vector<std::size_t> near;
    for (Index face = 0; face < faces.size(); ++face) {
        const auto own = static_cast<std::size_t>(planeOfFace_[static_cast<std::size_t>(face)]);
        const Vector3 centre = faces.centre.row(face).matrix().transpose();
        near.clear();
        bool exact = outerFree_[own];
        for (std::size_t plane = 0; plane < planes_.size() && exact; ++plane) {
            if (plane == own || gapTo(plane, centre) >= reach) {
                continue;
            }
            exact = outerFree_[plane] && square(plane, own);
            for (const std::size_t other : near) {
                exact = exact && (square(plane, other) || gap(plane, other) >= reach);
            }
            near.push_back(plane);
        }
        exact_[static_cast<std::size_t>(face)] = exact;
    }
}

void SurroundingsTable::walk(Index cell, double distance)
{
    const Vector3 centre = mesh_.centreOf(cell);
    ++stamp_;
    reached_.clear();
    queue_.assign(1, static_cast<std::int32_t>(cell));
    mark_[static_cast<std::size_t>(cell)] = stamp_;
    for (std::size_t next = 0; next < queue_.size(); ++next) {
        const std::int32_t here = queue_[next];
        const double away = (mesh_.centreOf(here) - centre).norm();
        if (away <= distance) {
            reached_.push_back(here);
        }
        if (away > distance + mesh_.radius[here]) {
            continue;  // a long cell that merely reaches into the cloud is walked through, one outside is not
        }
        for (const std::int32_t neighbour : mesh_.neighbours[here]) {
            if (mark_[static_cast<std::size_t>(neighbour)] != stamp_) {
                mark_[static_cast<std::size_t>(neighbour)] = stamp_;
                queue_.push_back(neighbour);
            }
        }
    }
    std::sort(reached_.begin(), reached_.end());
}

/// A plane serves a cell on its inner side when none of the space that its charges' images reach lies beyond it.
bool SurroundingsTable::planeServes(const WallPlane& plane, Index cell) const
{
    if (plane.distance(mesh_.centreOf(cell)) <= 0) {
        return false;  // behind a re-entrant edge: the mirror image would stand inside the mesh
    }
    const Vector3 mirrored = plane.mirror(mesh_.centreOf(cell));
    const double reach = radius_ + mesh_.radius[cell];
    for (const std::int32_t other : reached_) {
        const Vector3 centre = mesh_.centreOf(other);
        if (plane.distance(centre) < -beyond * mesh_.radius[other] && (centre - mirrored).norm() < reach) {
            return false;
        }
    }
    return true;
}

std::unique_ptr<Surroundings> SurroundingsTable::make(Index cell)
{
    auto around = std::make_unique<Surroundings>();
    const double reach = radius_ + mesh_.radius[cell];
    const Vector3 centre = mesh_.centreOf(cell);
    walk(cell, convex_ ? reach : 2 * reach);

    std::vector<std::int32_t> wallPlanes;
    const BoundaryFaces& faces = mesh_.boundary;
    for (const std::int32_t other : reached_) {
        for (const std::int32_t face : mesh_.facesOfCell[other]) {
            const double away = (faces.centre.row(face).matrix().transpose() - centre).norm();
            if (away > reach + faces.radius[face]) {
                continue;
            }
            wallPlanes.push_back(planeOfFace_[static_cast<std::size_t>(face)]);
            if (!exact_[static_cast<std::size_t>(face)]) {
                around->inexactWall = true;
                (face < mesh_.ownFaces ? around->unmirrored : around->unmirroredCopies).push_back(face);
            }
        }
    }
    std::sort(wallPlanes.begin(), wallPlanes.end());
    wallPlanes.erase(std::unique(wallPlanes.begin(), wallPlanes.end()), wallPlanes.end());
    for (const std::int32_t n : wallPlanes) {
        const WallPlane& plane = planes_[static_cast<std::size_t>(n)];
        if (outerFree_[static_cast<std::size_t>(n)] || planeServes(plane, cell)) {
            around->planes.push_back(n);
        } else {
            around->wallWithoutImage = true;
        }
    }

    bool freeWalls = true;
    for (const std::int32_t n : wallPlanes) {
        freeWalls = freeWalls && outerFree_[static_cast<std::size_t>(n)];
    }
    if (!freeWalls) {
        // Hidden is what lies in the cloud of some point of the cell but cannot be walked to.
        walk(cell, reach);
        for (Index other = 0; other < mesh_.cells() && !around->hides; ++other) {
            around->hides = (mesh_.centreOf(other) - centre).norm() <= reach + mesh_.radius[other]
                            && mark_[static_cast<std::size_t>(other)] != stamp_;
        }
    }
    if (!convex_ && freeWalls) {
        walk(cell, reach);
    }
    for (const std::int32_t other : reached_) {
        if (!around->cells.empty() && around->cells.back().end == other) {
            ++around->cells.back().end;
        } else {
            around->cells.push_back({other, other + 1});
        }
        if (other < mesh_.ownCells) {
            around->ownCentres.extend(mesh_.centreOf(other));
        }
    }
    around->cells.shrink_to_fit();
    around->count = static_cast<Index>(reached_.size());
    return around;
}

Vector3 Image::mirroredBack(Vector3 offset, const std::vector<WallPlane>& planes) const
{
    for (auto mirror = mirrors.rbegin(); mirror != mirrors.rend(); ++mirror) {
        if (*mirror >= 0) {
            const Vector3& normal = planes[static_cast<std::size_t>(*mirror)].normal;
            offset -= 2 * offset.dot(normal) * normal;
        }
    }
    return offset;
}

int imagesOf(const Vector3& position, const Surroundings& around, const std::vector<WallPlane>& planes,
             double cloudRadius, Image* images)
{
    if (around.planes.empty()) {
        return 0;
    }
    std::array<std::int32_t, 3> chosen{-1, -1, -1};
    const auto normalOf = [&](int n) -> const Vector3& {
        return planes[static_cast<std::size_t>(chosen[static_cast<std::size_t>(n)])].normal;
    };
    int count = 0;
    while (count < 3) {
        std::int32_t nearest = -1;
        double least = cloudRadius;
        for (const std::int32_t n : around.planes) {
            const WallPlane& plane = planes[static_cast<std::size_t>(n)];
            const double distance = plane.distance(position);
            bool free = distance > 0 && distance < least;
            for (int other = 0; free && other < count; ++other) {
                free = std::abs(plane.normal.dot(normalOf(other))) < sameWall;
            }
            if (free) {
                nearest = n;
                least = distance;
            }
        }
        if (nearest < 0) {
            break;
        }
        chosen[static_cast<std::size_t>(count++)] = nearest;
    }

    // Every image so far is mirrored in the next plane as well, when all its planes are perpendicular to that one.
    int made = 0;
    for (int n = 0; n < count; ++n) {
        const std::int32_t next = chosen[static_cast<std::size_t>(n)];
        const WallPlane& plane = planes[static_cast<std::size_t>(next)];
        const int before = made;
        images[made++] = {plane.mirror(position), plane.sign, {next, -1, -1}};
        for (int other = 0; other < before; ++other) {
            Image image = images[other];
            bool square = true;
            auto free = image.mirrors.begin();
            for (; *free >= 0; ++free) {
                square = square
                         && std::abs(planes[static_cast<std::size_t>(*free)].normal.dot(plane.normal)) < perpendicular;
            }
            if (square) {
                *free = next;
                image.position = plane.mirror(image.position);
                image.sign *= plane.sign;
                images[made++] = image;
            }
        }
    }
    return made;
}

}  // namespace him
