// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/exchange/mesh_locator.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

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
    bool inMesh(Index row) const
    {
        return points_ == 1 ? locator_.inMesh(row) : inside_[static_cast<std::size_t>(row)] > 0;
    }
    Index rowsOutside() const;  ///< of this rank

    /// Sums over particles of share times value, per local cell, N values of a particle at once. Each total is that over all rows
    /// in the mesh. Collective.
    /// @param valuesOf  std::array<double, N> of a row in the mesh
    template <std::size_t N, class ValuesOf> void deposit(const ValuesOf& valuesOf, CellValues& ofCell);
    /// Per row the means over its shares of values of the cells, one row per local cell. Collective.
    /// @param take  called once for every row with its number and its means (const double*)
    template <class Take> void gather(const CellValues& ofCell, const Take& take);
    /// Per row the mean over its points of a value that varies inside the cells. Collective; valueAt is called on the rank of
    /// the cell.
    /// @param particles  those of locate()
    /// @param valueAt    of a local cell and a point in it [m]
    void gather(const DemParticles& particles, const std::function<Vector3(Index, const Vector3&)>& valueAt,
                Points& ofRow);

private:
    MeshLocator locator_;
    Index points_;  ///< per particle
    Index rows_ = 0;
    std::vector<std::int8_t> inside_;  ///< points of each row in the mesh; empty with one point per particle
    Points place_;                     ///< of all points, row by row [m]
    std::vector<double> sums_;         ///< of every row over its points; keeps its memory for any number of columns
    Points pointVector_;
};

template <std::size_t N, class ValuesOf> void ParticleShares::deposit(const ValuesOf& valuesOf, CellValues& ofCell)
{
    if (points_ == 1) {
        locator_.deposit<N>(valuesOf, ofCell);
        return;
    }
    // The points of a row come one after the other.
    Index last = -1;
    std::array<double, N> share{};
    const auto ofPoint = [&](Index point) {
        const Index row = point / points_;
        if (row != last) {
            last = row;
            share = valuesOf(row);
            for (double& value : share) {
                value /= inside_[static_cast<std::size_t>(row)];
            }
        }
        return share;
    };
    locator_.deposit<N>(ofPoint, ofCell);
}

template <class Take> void ParticleShares::gather(const CellValues& ofCell, const Take& take)
{
    if (points_ == 1) {
        locator_.gather(ofCell, take);
        return;
    }
    const auto columns = static_cast<std::size_t>(ofCell.cols());
    sums_.assign(static_cast<std::size_t>(rows_) * columns, 0.0);
    locator_.gather(ofCell, [&](Index point, const double* values) {
        double* const sum = sums_.data() + static_cast<std::size_t>(point / points_) * columns;
        for (std::size_t k = 0; k < columns; ++k) {
            sum[k] += values[k];
        }
    });
    for (Index row = 0; row < rows_; ++row) {
        double* const sum = sums_.data() + static_cast<std::size_t>(row) * columns;
        const int inside = inside_[static_cast<std::size_t>(row)];
        for (std::size_t k = 0; inside > 0 && k < columns; ++k) {
            sum[k] /= inside;
        }
        take(row, sum);
    }
}

}  // namespace him
