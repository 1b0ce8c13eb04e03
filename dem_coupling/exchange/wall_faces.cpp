// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/wall_faces.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace him {

namespace {

/// Distances that differ by less than this share of the reach are equal: round-off of the corners.
constexpr double sameDistance = 1e-9;

/// Point of the triangle a b c nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3 nearestInTriangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c)
{
    const Vector3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) {
        return a;
    }
    const Vector3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) {
        return b;
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return a + d1 / (d1 - d3) * ab;
    }
    const Vector3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) {
        return c;
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return a + d2 / (d2 - d6) * ac;
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    const double scale = 1 / (va + vb + vc);
    return a + ab * (vb * scale) + ac * (vc * scale);
}

std::vector<double> packed(const std::vector<WallFacePolygon>& faces)
{
    std::vector<double> data;
    for (const WallFacePolygon& face : faces) {
        data.push_back(face.wall);
        data.push_back(static_cast<double>(face.corners.size()));
        for (const Vector3& corner : face.corners) {
            data.insert(data.end(), corner.data(), corner.data() + 3);
        }
    }
    return data;
}

/// Whether a face is the whole of its box, a rectangle along the axes, to round-off.
/// @param area  of the face [m2]
bool fillsBox(const std::vector<Vector3>& corners, double area, const Box& box)
{
    const Vector3 size = box.size();
    const double whole = size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
    const double tolerance = sameDistance * size.maxCoeff();
    return corners.size() == 4 && size.minCoeff() <= tolerance && area >= (1 - 4 * sameDistance) * whole
           && std::all_of(corners.begin(), corners.end(), [&](const Vector3& corner) {
                  return (corner - box.lower).cwiseMin(box.upper - corner).maxCoeff() <= tolerance;
              });
}

/// Lexicographic order that takes nearly equal numbers for equal.
bool before(const Vector3& a, const Vector3& b, double tolerance)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(a[axis] - b[axis]) > tolerance) {
            return a[axis] < b[axis];
        }
    }
    return false;
}

}  // namespace

WallFaces::WallFaces(const std::vector<WallFacePolygon>& mine, double reach, MPI_Comm communicator)
    : exchange_(communicator), reach_(reach)
{
    const std::vector<double> own = packed(mine);
    const auto ranks = static_cast<std::size_t>(exchange_.ranks());
    std::vector<int> counts(ranks), starts(ranks);
    const int count = static_cast<int>(own.size());
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t rank = 1; rank < ranks; ++rank) {
        starts[rank] = starts[rank - 1] + counts[rank - 1];
    }
    std::vector<double> data(static_cast<std::size_t>(starts.back() + counts.back()));
    MPI_Allgatherv(own.data(), count, MPI_DOUBLE, data.data(), counts.data(), starts.data(), MPI_DOUBLE, communicator);

    double largest = 0;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        firstOfRank_.push_back(static_cast<Index>(faces_.size()));
        const double* in = data.data() + starts[rank];
        const double* end = in + counts[rank];
        while (in < end) {
            WallFacePolygon face;
            face.wall = static_cast<int>(*in++);
            face.corners.resize(static_cast<std::size_t>(*in++));
            Vector3 centre = Vector3::Zero();
            for (Vector3& corner : face.corners) {
                corner = Vector3(in);
                in += 3;
                centre += corner / static_cast<double>(face.corners.size());
            }
            Vector3 normal = Vector3::Zero();
            for (std::size_t n = 1; n + 1 < face.corners.size(); ++n) {
                normal += (face.corners[n] - face.corners[0]).cross(face.corners[n + 1] - face.corners[0]);
            }
            for (const Vector3& corner : face.corners) {
                largest = std::max(largest, (corner - centre).norm());
            }
            Box box;
            for (const Vector3& corner : face.corners) {
                box.extend(corner);
            }
            candidates_.push_back({box, face.wall, fillsBox(face.corners, 0.5 * normal.norm(), box)});
            centres_.push_back(centre);
            normals_.push_back(normal.normalized());
            faces_.push_back(std::move(face));
        }
    }
    firstOfRank_.push_back(static_cast<Index>(faces_.size()));

    layBins(largest);
}

void WallFaces::layBins(double largest)
{
    binSize_ = largest + reach_;  // a handful of faces in each
    const Vector3 margin = Vector3::Constant(reach_ * (1 + sameDistance));
    std::unordered_map<Bin, std::vector<std::int32_t>, BinHash> facesOfBin;
    for (std::size_t face = 0; face < faces_.size(); ++face) {
        const Box& box = candidates_[face].box;
        const Bin low = binOf(box.lower - margin), high = binOf(box.upper + margin);
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                    facesOfBin[{x, y, z}].push_back(static_cast<std::int32_t>(face));
                }
            }
        }
    }
    for (const auto& bin : facesOfBin) {
        const auto first = static_cast<std::uint32_t>(binFaces_.size());
        binFaces_.insert(binFaces_.end(), bin.second.begin(), bin.second.end());
        bins_[bin.first] = {first, static_cast<std::uint32_t>(binFaces_.size())};
    }
}

WallFaces::Bin WallFaces::binOf(const Vector3& point) const
{
    const auto number = [&](int axis) { return static_cast<std::int64_t>(std::floor(point[axis] / binSize_)); };
    return {number(0), number(1), number(2)};
}

double WallFaces::distance(const Vector3& point, Index face) const
{
    const std::vector<Vector3>& corners = faces_[static_cast<std::size_t>(face)].corners;
    double least = std::numeric_limits<double>::max();
    for (std::size_t n = 1; n + 1 < corners.size(); ++n) {
        least = std::min(least, (point - nearestInTriangle(point, corners[0], corners[n], corners[n + 1])).norm());
    }
    return least;
}

WallFaces::Place WallFaces::find(const Vector3& point, int wall) const
{
    Place best;
    const auto bin = bins_.find(binOf(point));
    if (bin == bins_.end()) {
        return best;
    }
    const double tolerance = sameDistance * (reach_ + binSize_);
    constexpr double never = std::numeric_limits<double>::infinity();
    const auto boxDistance = [&](Index face) {
        const Candidate& candidate = candidates_[static_cast<std::size_t>(face)];
        return serves(candidate.wall, wall) ? candidate.box.squaredDistance(point) : never;
    };
    // Whether a face whose box is so far away can still be the one.
    const auto isUseful = [&](double squared) {
        const double useful = tolerance + (best.face < 0 ? reach_ : std::min(reach_, best.distance + tolerance));
        return squared <= useful * useful;
    };
    const auto consider = [&](Index face, double squared) {
        const double away =
            candidates_[static_cast<std::size_t>(face)].fillsBox ? std::sqrt(squared) : distance(point, face);
        if (away > reach_) {
            return;
        }
        const bool nearer = best.face < 0 || away < best.distance - tolerance;
        const bool asNear = best.face >= 0 && std::abs(away - best.distance) <= tolerance;
        if (nearer || (asNear && before(centreOf(face), centreOf(best.face), tolerance))) {
            best = {face, away};
        }
    };
    // No face is nearer than its box. The face of the nearest box is nearly always the one, and nearly always rules out the rest.
    double least = never, second = never;
    Index first = -1;
    for (std::uint32_t n = bin->second.first; n < bin->second.end; ++n) {
        const double squared = boxDistance(binFaces_[n]);
        if (squared < least) {
            second = least;
            least = squared;
            first = binFaces_[n];
        } else {
            second = std::min(second, squared);
        }
    }
    if (first < 0 || !isUseful(least)) {
        return best;
    }
    consider(first, least);
    if (isUseful(second)) {
        for (std::uint32_t n = bin->second.first; n < bin->second.end; ++n) {
            const double squared = boxDistance(binFaces_[n]);
            if (binFaces_[n] != first && isUseful(squared)) {
                consider(binFaces_[n], squared);
            }
        }
    }
    return best;
}

double WallFaces::distanceTo(const Vector3& point, int wall) const
{
    double least = std::numeric_limits<double>::infinity();
    for (Index face = 0; face < static_cast<Index>(faces_.size()); ++face) {
        if (serves(faces_[static_cast<std::size_t>(face)].wall, wall)) {
            least = std::min(least, distance(point, face));
        }
    }
    return least;
}

void WallFaces::collect(const std::vector<Index>& faces, const std::vector<double>& charges, Scalars& own)
{
    exchange_.clear(outgoing_);
    for (std::size_t n = 0; n < faces.size(); ++n) {
        const auto after = std::upper_bound(firstOfRank_.begin(), firstOfRank_.end(), faces[n]);
        const auto rank = static_cast<std::size_t>(after - firstOfRank_.begin()) - 1;
        outgoing_[rank].push_back(static_cast<double>(faces[n] - firstOfRank_[rank]));
        outgoing_[rank].push_back(charges[n]);
    }
    exchange_.exchange(outgoing_, incoming_);
    const auto self = static_cast<std::size_t>(exchange_.rank());
    own.setZero(firstOfRank_[self + 1] - firstOfRank_[self]);
    for (const std::vector<double>& from : incoming_) {
        for (std::size_t n = 0; n < from.size(); n += 2) {
            own[static_cast<Index>(from[n])] += from[n + 1];
        }
    }
}

}  // namespace him
