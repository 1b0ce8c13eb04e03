// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/charged_walls.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Panels are no longer than this share of the cloud radius.
constexpr double longestPanel = 0.5;

/// A panel's points serve from this many of its radii on: their field is within 1.5 % of the panel's there, which does not show in
/// the errors of clouds of two and three cells.
constexpr double nearRadii = 2.0;

}  // namespace

ChargedWalls::ChargedWalls(const PoissonMesh& mesh, MeshHalo& halo, SurroundingsTable& table, double cloudRadius)
    : mesh_(mesh)
{
    const std::vector<ChargedFace> own = mesh.chargedFaces();
    ownFaces_ = static_cast<Index>(own.size());
    SparseExchange& exchange = halo.exchange();
    const auto ranks = static_cast<std::size_t>(exchange.ranks());
    sentFaces_.resize(ranks);
    receivedFaces_.assign(ranks, 0);
    exchange.clear(outgoing_);
    for (std::size_t face = 0; face < own.size(); ++face) {
        takeFace(own[face].corners, own[face].cell, table, cloudRadius);
        for (auto n = halo.firstHolder(own[face].cell); n < halo.firstHolder(own[face].cell + 1); ++n) {
            const MeshHalo::Holder& holder = halo.holders()[static_cast<std::size_t>(n)];
            std::vector<double>& out = outgoing_[static_cast<std::size_t>(holder.rank)];
            out.insert(out.end(), {static_cast<double>(holder.copy), static_cast<double>(own[face].corners.size())});
            for (const Vector3& corner : own[face].corners) {
                const Vector3 there = corner + holder.shift;
                out.insert(out.end(), there.begin(), there.end());
            }
            sentFaces_[static_cast<std::size_t>(holder.rank)].push_back(static_cast<std::int32_t>(face));
        }
    }
    exchange.exchange(outgoing_, incoming_);
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        for (std::size_t at = 0; at < incoming_[rank].size(); ++receivedFaces_[rank]) {
            const auto cell = static_cast<std::int32_t>(incoming_[rank][at]);
            std::vector<Vector3> corners(static_cast<std::size_t>(incoming_[rank][at + 1]));
            at += 2;
            for (Vector3& corner : corners) {
                corner = Eigen::Map<const Vector3>(incoming_[rank].data() + at);
                at += 3;
            }
            takeFace(corners, cell, table, cloudRadius);
        }
    }
    faceCharge_.setZero(static_cast<Index>(faceCell_.size()));

    orderPanels();
}

void ChargedWalls::orderPanels()
{
    Points centres(static_cast<Index>(panels_.size()), 3);
    double reach = 0;
    for (std::size_t n = 0; n < panels_.size(); ++n) {
        centres.row(static_cast<Index>(n)) = panels_[n].shape.centre.transpose().array();
        reach = std::max(reach, nearRadii * panels_[n].shape.radius);
    }
    panelCells_.build(centres, 0, centres.rows(), reach);
    std::vector<Panel> ordered;
    ordered.reserve(panels_.size());
    panelCentre_.resize(centres.rows(), 3);
    panelNearSquared_.resize(centres.rows());
    panelCharge_.setZero(centres.rows());
    for (const std::int32_t panel : panelCells_.order()) {
        const auto at = static_cast<Index>(ordered.size());
        ordered.push_back(std::move(panels_[static_cast<std::size_t>(panel)]));
        panelCentre_.row(at) = centres.row(panel);
        const double near = nearRadii * ordered.back().shape.radius;
        panelNearSquared_[at] = near * near;
    }
    panels_ = std::move(ordered);
}

void ChargedWalls::takeFace(const std::vector<Vector3>& corners, std::int32_t cell, SurroundingsTable& table,
                            double cloudRadius)
{
    const auto face = static_cast<std::int32_t>(faceCell_.size());
    faceCell_.push_back(cell);
    const std::vector<ChargedPanel> pieces = panelsOf(corners, longestPanel * cloudRadius);
    double area = 0;
    for (const ChargedPanel& piece : pieces) {
        area += piece.area;
    }
    const std::vector<WallPlane>& planes = table.planes();
    Image images[mostImages], most[mostImages];
    for (const ChargedPanel& piece : pieces) {
        const double share = piece.area / area;
        // The images of a panel are those of the point that has the most; where another has none, it is out of reach of them.
        int count = 0;
        for (const ChargedPanel::Point& point : piece.points()) {
            points_.push_back({point.position, share * point.share, face});
            const int found = imagesOf(point.position, table.of(cell), planes, cloudRadius, images);
            if (found > count) {
                count = found;
                std::copy_n(images, found, most);
            }
        }
        panels_.push_back({piece, piece.points(), share, face});
        for (int n = 0; n < count; ++n) {
            std::array<Vector3, 4> corner = piece.corner;
            for (const std::int32_t plane : most[n].mirrors) {
                for (Vector3& place : corner) {
                    place = plane < 0 ? place : planes[static_cast<std::size_t>(plane)].mirror(place);
                }
            }
            const ChargedPanel mirrored = panelWith(corner, piece.corners);
            panels_.push_back({mirrored, mirrored.points(), most[n].sign * share, face});
        }
    }
}

void ChargedWalls::update(SparseExchange& exchange)
{
    Scalars own;
    mesh_.faceCharges(own);
    faceCharge_.head(ownFaces_) = own;
    exchange.clear(outgoing_);
    exchange.clear(incoming_);
    for (std::size_t rank = 0; rank < sentFaces_.size(); ++rank) {
        for (const std::int32_t face : sentFaces_[rank]) {
            outgoing_[rank].push_back(own[face]);
        }
        incoming_[rank].resize(static_cast<std::size_t>(receivedFaces_[rank]));
    }
    exchange.answer(outgoing_, incoming_);
    Index face = ownFaces_;
    for (const auto& charges : incoming_) {
        for (const double charge : charges) {
            faceCharge_[face++] = charge;
        }
    }
    for (std::size_t n = 0; n < panels_.size(); ++n) {
        panelCharge_[static_cast<Index>(n)] = panels_[n].share * faceCharge_[panels_[n].face];
    }
}

void ChargedWalls::appendTo(CloudSources& sources) const
{
    Index rows = sources.size();
    for (const Point& point : points_) {
        rows += faceCharge_[point.face] != 0;
    }
    Index row = sources.size();
    sources.position.conservativeResize(rows, 3);
    sources.charge.conservativeResize(rows);
    for (const Point& point : points_) {
        if (faceCharge_[point.face] != 0) {
            sources.position.row(row) = point.position.transpose().array();
            sources.charge[row++] = point.share * faceCharge_[point.face];
            sources.cell.push_back(faceCell_[static_cast<std::size_t>(point.face)]);
        }
    }
}

void ChargedWalls::addNearPanels(const CloudSources& sources, double permittivity, Points& field,
                                 Scalars& potential) const
{
    const double coulombConstant = 1.0 / (4.0 * pi * permittivity);
    LinkedCells::Ranges ranges;
    for (Index target = 0; target < sources.targets && !panels_.empty(); ++target) {
        const Vector3 place = sources.position.row(target).matrix().transpose();
        Box box;
        box.extend(place);
        panelCells_.rangesAround(box, ranges);
        for (int n = 0; n < ranges.count; ++n) {
            for (auto at = ranges.range[static_cast<std::size_t>(n)].begin;
                 at < ranges.range[static_cast<std::size_t>(n)].end; ++at) {
                const double x = place[0] - panelCentre_(at, 0);
                const double y = place[1] - panelCentre_(at, 1);
                const double z = place[2] - panelCentre_(at, 2);
                if (x * x + y * y + z * z >= panelNearSquared_[at] || panelCharge_[at] == 0) {
                    continue;
                }
                const Panel& panel = panels_[static_cast<std::size_t>(at)];
                const double charge = coulombConstant * panelCharge_[at];
                Vector3 more = Vector3::Zero();
                double morePotential = 0;
                panel.shape.addField(place, charge, more, morePotential);
                for (const ChargedPanel::Point& point : panel.points) {
                    const Vector3 r = place - point.position;
                    const double inverse = 1.0 / r.norm();
                    more -= charge * point.share * inverse * inverse * inverse * r;
                    morePotential -= charge * point.share * inverse;
                }
                field.row(target) += more.transpose().array();
                potential[target] += morePotential;
            }
        }
    }
}

}  // namespace him
