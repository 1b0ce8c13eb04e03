// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/particle_shares.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Unit directions of the sub-points around the centre.
std::array<Vector3, 14> directions()
{
    std::array<Vector3, 14> all;
    std::size_t n = 0;
    for (int axis = 0; axis < 3; ++axis) {
        all[n++] = Vector3::Unit(axis);
        all[n++] = -Vector3::Unit(axis);
    }
    const double diagonal = 1 / std::sqrt(3.0);
    for (const double x : {-diagonal, diagonal}) {
        for (const double y : {-diagonal, diagonal}) {
            for (const double z : {-diagonal, diagonal}) {
                all[n++] = Vector3(x, y, z);
            }
        }
    }
    return all;
}

/// 14/15 of this squared is 3/5, the mean of (distance to the centre)^2 in a sphere of radius 1.
const double shell = std::sqrt(9.0 / 14.0);

}  // namespace

ParticleShares::ParticleShares(const CellMesh& mesh, MPI_Comm communicator, const Box& demBox,
                               const std::array<bool, 3>& periodic, bool subPoints)
    : locator_(mesh, communicator, demBox, periodic), points_(subPoints ? 15 : 1)
{
}

void ParticleShares::locate(const DemParticles& particles)
{
    static const std::array<Vector3, 14> around = directions();
    rows_ = particles.size();
    if (points_ == 1) {
        locator_.locate(particles.position);
        return;
    }
    place_.resize(points_ * rows_, 3);
    for (Index row = 0; row < rows_; ++row) {
        place_.row(points_ * row) = particles.position.row(row);
        for (std::size_t n = 0; n < around.size(); ++n) {
            place_.row(points_ * row + 1 + static_cast<Index>(n)) =
                particles.position.row(row) + shell * particles.radius[row] * around[n].transpose().array();
        }
    }
    locator_.locate(place_);
    inside_.assign(static_cast<std::size_t>(rows_), 0);
    for (Index row = 0; row < rows_; ++row) {
        for (Index point = points_ * row; point < points_ * (row + 1); ++point) {
            inside_[static_cast<std::size_t>(row)] += locator_.inMesh(point);
        }
    }
}

Index ParticleShares::rowsOutside() const
{
    Index outside = 0;
    for (Index row = 0; row < rows_; ++row) {
        outside += !inMesh(row);
    }
    return outside;
}

void ParticleShares::gather(const DemParticles& particles, const std::function<Vector3(Index, const Vector3&)>& valueAt,
                            Points& ofRow)
{
    if (points_ == 1) {
        locator_.gather(particles.position, valueAt, ofRow);
        return;
    }
    locator_.gather(place_, valueAt, pointVector_);
    ofRow.setZero(rows_, 3);
    for (Index row = 0; row < rows_; ++row) {
        const int inside = inside_[static_cast<std::size_t>(row)];
        if (inside > 0) {
            ofRow.row(row) = pointVector_.middleRows(points_ * row, points_).colwise().sum() / inside;
        }
    }
}

}  // namespace him
