// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/sparse_exchange.hpp"
#include "electrostatics/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace him {

/// A face of the mesh that carries charge: its corners, in order around it [m].
struct WallFacePolygon {
    int wall = 0;  ///< number of the insulating wall that it belongs to
    std::vector<Vector3> corners;
};

/// The faces of all ranks' insulating walls, known to every rank (walls have few faces against the cells of a mesh), so that
/// each rank finds the face under its own contacts and sends charge straight to the rank that counts the face.
class WallFaces {
public:
    /// Collective.
    /// @param mine   faces that this rank counts; their order is that of collect()
    /// @param reach  distance from a face up to which points are on it [m]
    WallFaces(const std::vector<WallFacePolygon>& mine, double reach, MPI_Comm communicator);

    static constexpr int anyWall = -1;

    /// Where a point lies. Of faces at equal distance (a contact on an edge) the one with the smallest centre in x, then y,
    /// then z is taken, so that the choice does not depend on how the mesh is cut.
    struct Place {
        Index face = -1;      ///< among all(); -1 when none is within reach
        double distance = 0;  ///< [m]
    };
    Place find(const Vector3& point, int wall) const;
    /// Distance [m] to the nearest face however far it is; infinity when the wall has none. Looks at all faces.
    double distanceTo(const Vector3& point, int wall) const;

    /// Sends charges [C] to the ranks that count their faces and adds them up there. Collective.
    /// @param faces, charges  of this rank's contacts, numbers among all()
    /// @param own             one per face of `mine`
    void collect(const std::vector<Index>& faces, const std::vector<double>& charges, Scalars& own);

    /// All faces, rank by rank.
    const std::vector<WallFacePolygon>& all() const { return faces_; }
    Vector3 centreOf(Index face) const { return centres_[static_cast<std::size_t>(face)]; }
    Vector3 normalOf(Index face) const { return normals_[static_cast<std::size_t>(face)]; }
    double reach() const { return reach_; }

private:
    using Bin = std::array<std::int64_t, 3>;
    struct BinHash {
        std::size_t operator()(const Bin& bin) const
        {
            std::uint64_t mixed = 0;
            for (const std::int64_t number : bin) {
                mixed = (mixed ^ static_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15u;
                mixed ^= mixed >> 32;
            }
            return mixed;
        }
    };
    /// What find() asks of a face first.
    struct Candidate {
        Box box;  ///< around the corners
        int wall;
        bool fillsBox;  ///< a rectangle along the axes: as far as its box
    };
    /// A bin's part of binFaces_.
    struct Range {
        std::uint32_t first = 0, end = 0;
    };
    void layBins(double largest);
    Bin binOf(const Vector3& point) const;
    double distance(const Vector3& point, Index face) const;
    static bool serves(int wallOfFace, int wall) { return wall == anyWall || wallOfFace == wall; }

    SparseExchange exchange_;
    double reach_;
    double binSize_ = 1;  ///< [m]
    std::vector<WallFacePolygon> faces_;
    std::vector<Vector3> centres_, normals_;
    std::vector<Index> firstOfRank_;  ///< one more than ranks
    // Small, because contacts come in no order and a gas step has driven all this out of the cache.
    std::vector<Candidate> candidates_;   ///< of every face
    std::vector<std::int32_t> binFaces_;  ///< faces whose reach touches a bin, bin by bin
    std::unordered_map<Bin, Range, BinHash> bins_;
    SparseExchange::Buffers outgoing_, incoming_;
};

}  // namespace him
