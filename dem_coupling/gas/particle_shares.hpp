// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/exchange/mesh_locator.hpp"

#include <functional>

namespace him {

/// Which share of every particle lies in which cell, and the sums over particles and means over cells that follow.
///
/// With one point per particle all of it is where its centre is. With sub-points a particle has 15 points of equal weight:
/// its centre, six along the axes and eight along the diagonals at 0.802 of its radius, which gives them the second
/// moment of the sphere. Points beyond a wall give their share to those inside.
class ParticleShares {
public:
    /// Collective. The mesh outlives this.
    ParticleShares(const CellMesh& mesh, MPI_Comm communicator, const Box& demBox, const std::array<bool, 3>& periodic,
                   bool subPoints);

    /// Collective.
    void locate(const DemParticles& particles);
    /// Whether any point of a row is in the mesh; others give nothing and gather zero.
    bool inMesh(Index row) const { return inside_[static_cast<std::size_t>(row)] > 0; }
    Index rowsOutside() const;  ///< of this rank

    /// Sums over particles of share times value, per local cell; one column for each of a particle's values. A column's total is
    /// that over all rows in the mesh. Collective.
    void deposit(const Eigen::ArrayXXd& ofRow, Eigen::ArrayXXd& ofCell);
    /// Per row the means over its shares of values of the cells, one row per local cell. Collective.
    void gather(const Eigen::ArrayXXd& ofCell, Eigen::ArrayXXd& ofRow);
    /// Per row the mean over its points of a value that varies inside the cells. Collective; valueAt is called on the rank of
    /// the cell.
    /// @param particles  those of locate()
    /// @param valueAt    of a local cell and a point in it [m]
    void gather(const DemParticles& particles, const std::function<Vector3(Index, const Vector3&)>& valueAt,
                Points& ofRow);

private:
    /// Room for values of all points, one column each.
    Eigen::Map<Eigen::ArrayXXd> pointValues(Index columns);
    /// Per row the mean of a value over its points in the mesh.
    template <class OfPoint, class OfRow> void meanOfPoints(const OfPoint& ofPoint, OfRow& ofRow) const;

    MeshLocator locator_;
    Index points_;                     ///< per particle
    std::vector<int> inside_;          ///< points of each row in the mesh
    Points place_;                     ///< of all points, row by row [m]
    std::vector<double> pointMemory_;  ///< kept for any number of columns
    Points pointVector_;
};

}  // namespace him
