// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/mesh_arrays.hpp"
#include "electrostatics/types.hpp"

#include <cstdint>
#include <vector>

namespace him {

/// Lists of indices, one per row, in one array.
struct IndexLists {
    std::vector<std::int32_t> first{0};  ///< one more than rows
    std::vector<std::int32_t> entries;

    struct Row {
        const std::int32_t* from;
        const std::int32_t* to;
        const std::int32_t* begin() const { return from; }
        const std::int32_t* end() const { return to; }
    };
    Row operator[](Index row) const
    {
        return {entries.data() + first[static_cast<std::size_t>(row)], entries.data() + first[static_cast<std::size_t>(row) + 1]};
    }
    void closeRow() { first.push_back(static_cast<std::int32_t>(entries.size())); }
};

/// A rank's own cells followed by copies of the cells around them, of other ranks and of periodic images, so that every
/// stencil of an own cell finds its points here. Cells are joined through the faces between them and through nothing else:
/// what a baffle separates is far apart here, however near it is in space.
struct LocalMesh {
    Index ownCells = 0;
    Points centre;              ///< own cells, then copies [m]
    Scalars volume;             ///< [m3]
    Scalars radius;             ///< largest distance from a cell's centre to its points [m]
    IndexLists neighbours;      ///< cells across the faces of each cell, as far as they are here
    BoundaryFaces boundary;     ///< own faces in the order of MeshArrays::boundary, then those of the copies
    Index ownFaces = 0;
    IndexLists facesOfCell;     ///< boundary faces of each cell

    Index cells() const { return centre.rows(); }
    Vector3 centreOf(Index cell) const { return centre.row(cell).matrix().transpose(); }
};

/// Cube root of a cell's volume, its size h [m].
double cellSize(const LocalMesh& mesh, Index cell);

}  // namespace him
