// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/p3m/local_mesh.hpp"
#include "electrostatics/pair_kernels.hpp"

#include <array>
#include <memory>
#include <vector>

namespace him {

/// A plane in which charges may be mirrored: one planar piece of the boundary, or one facet of a curved one.
struct WallPlane {
    Vector3 point;   ///< [m]
    Vector3 normal;  ///< unit, out of the mesh
    double sign;     ///< of the image charge: -1 at a conductor, +1 at an insulated face

    /// Distance [m] from the plane, positive inside.
    double distance(const Vector3& x) const { return (point - x).dot(normal); }
    Vector3 mirror(const Vector3& x) const { return x + 2 * distance(x) * normal; }
};

/// What a charge in one cell reaches with a cloud of radius R: cells and boundary faces that can be walked to from its cell
/// without leaving the cloud. A charge acts through its short-range part, its cloud and its images on these alone, so what
/// lies behind a baffle does not feel it; the potential of the mesh carries the rest.
struct Surroundings {
    std::vector<RowRange> cells;  ///< runs of consecutive cell numbers
    Index count = 0;              ///< cells in all of these
    Box ownCentres;               ///< around the centres of the rank's own cells among these [m]; empty: there are none
    std::vector<std::int32_t> planes;            ///< planes in which its charges may be mirrored
    std::vector<std::int32_t> unmirrored;        ///< own boundary faces whose value the images do not make zero
    std::vector<std::int32_t> unmirroredCopies;  ///< the same of other ranks and periods
    bool inexactWall = false;        ///< some boundary face in reach is not mirrored exactly (curved walls, wedges)
    bool wallWithoutImage = false;   ///< some boundary face in reach lies in none of the planes
    bool hides = false;              ///< some cell in reach of the cloud cannot be walked to
    bool reaches(Index cell) const;  ///< whether the cell is among `cells`
};

/// Surroundings of the cells of a local mesh, each made when first asked for and then kept.
class SurroundingsTable {
public:
    /// @param mesh         outlives the table
    /// @param cloudRadius  R [m]
    SurroundingsTable(const LocalMesh& mesh, double cloudRadius);

    const Surroundings& of(Index cell)
    {
        auto& entry = table_[static_cast<std::size_t>(cell)];
        if (!entry) {
            entry = make(cell);
        }
        return *entry;
    }
    const std::vector<WallPlane>& planes() const { return planes_; }
    /// Plane of a boundary face, an index into planes().
    Index planeOf(Index face) const { return planeOfFace_[static_cast<std::size_t>(face)]; }
    /// Whether the images of every charge make the value of this boundary face exactly that of the case.
    bool mirrorsExactly(Index face) const { return exact_[static_cast<std::size_t>(face)]; }

private:
    void findPlanes();
    void findExactFaces();
    std::unique_ptr<Surroundings> make(Index cell);
    /// Cells that can be walked to from `cell` within `distance` [m] of its centre, in ascending order.
    void walk(Index cell, double distance);
    bool planeServes(const WallPlane& plane, Index cell) const;

    const LocalMesh& mesh_;
    double radius_;
    std::vector<WallPlane> planes_;
    std::vector<std::int32_t> planeOfFace_;
    std::vector<bool> outerFree_;  ///< of each plane: no cell of the mesh lies beyond it
    bool convex_ = true;           ///< no plane has a cell beyond it
    std::vector<bool> exact_;
    std::vector<std::unique_ptr<Surroundings>> table_;
    std::vector<std::int32_t> reached_, queue_;  ///< scratch of walk()
    std::vector<std::int32_t> mark_;
    std::int32_t stamp_ = 0;
};

/// Images of a charge: mirrored in up to three planes that its cloud touches, the nearest first, and in the edges (3) and
/// corners (7) of those that are perpendicular.
struct Image {
    Vector3 position;                     ///< [m]
    double sign;                          ///< image charge over charge
    std::array<std::int32_t, 3> mirrors;  ///< planes that made it, one after the other, -1 behind the last

    /// The vector that the mirrors turn into `offset`.
    Vector3 mirroredBack(Vector3 offset, const std::vector<WallPlane>& planes) const;
};
constexpr int mostImages = 7;
/// @return number of images written
int imagesOf(const Vector3& position, const Surroundings& around, const std::vector<WallPlane>& planes,
             double cloudRadius, Image* images);

}  // namespace him
