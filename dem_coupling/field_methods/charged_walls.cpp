// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/charged_walls.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

void ChargedWalls::addNearPanels(const CloudSources& sources, double permittivity, Points& field, Scalars& potential)
{
    if (panels_.empty()) {
        return;
    }
    findNearRuns(sources);
    const double coulombConstant = 1.0 / (4.0 * pi * permittivity);
    const double* x = sources.position.col(0).data();
    const double* y = sources.position.col(1).data();
    const double* z = sources.position.col(2).data();
    for (std::size_t panel = 0; panel < panels_.size(); ++panel) {
        const auto at = static_cast<Index>(panel);
        const double charge = coulombConstant * panelCharge_[at];
        const double px = panelCentre_(at, 0), py = panelCentre_(at, 1), pz = panelCentre_(at, 2);
        nearPlaces_.clear();
        for (auto n = firstNearRun_[panel]; n < firstNearRun_[panel + 1]; ++n) {
            const RowRange& run = runs_[static_cast<std::size_t>(nearRuns_[static_cast<std::size_t>(n)])];
            for (Index target = run.begin; target < run.end; ++target) {
                const double dx = x[target] - px, dy = y[target] - py, dz = z[target] - pz;
                // Written always and counted when near: which it is can not be foretold, and a branch would cost more.
                nearTargets_[static_cast<std::size_t>(nearPlaces_.count)] = target;
                nearPlaces_.append(x[target], y[target], z[target],
                                   dx * dx + dy * dy + dz * dz < panelNearSquared_[at]);
                if (nearPlaces_.full()) {
                    addNearPanel(panels_[panel], charge, field, potential);
                }
            }
        }
        if (nearPlaces_.count > 0) {
            addNearPanel(panels_[panel], charge, field, potential);
        }
    }
}

/// Targets follow one another by cells. Finds the charged panels near each such run, and sorts what is found by panel.
void ChargedWalls::findNearRuns(const CloudSources& sources)
{
    runs_.clear();
    found_.clear();
    firstNearRun_.assign(panels_.size() + 1, 0);
    LinkedCells::Ranges ranges;
    for (Index first = 0; first < sources.targets;) {
        Index end = first;
        Box box;
        const std::int32_t cell = sources.cell[static_cast<std::size_t>(first)];
        while (end < sources.targets && sources.cell[static_cast<std::size_t>(end)] == cell) {
            box.extend(sources.position.row(end++).matrix().transpose());
        }
        panelCells_.rangesAround(box, ranges);
        for (int n = 0; n < ranges.count; ++n) {
            const RowRange& panels = ranges.range[static_cast<std::size_t>(n)];
            for (auto panel = panels.begin; panel < panels.end; ++panel) {
                const Vector3 centre = panelCentre_.row(panel).matrix().transpose();
                if (panelCharge_[panel] != 0 && box.squaredDistance(centre) < panelNearSquared_[panel]) {
                    found_.push_back({static_cast<std::int32_t>(panel), static_cast<std::int32_t>(runs_.size())});
                    ++firstNearRun_[static_cast<std::size_t>(panel)];
                }
            }
        }
        runs_.push_back({first, end});
        first = end;
    }
    // Ends, which the loop below turns into starts by filling from the back.
    std::partial_sum(firstNearRun_.begin(), firstNearRun_.end(), firstNearRun_.begin());
    nearRuns_.resize(found_.size());
    for (auto n = found_.rbegin(); n != found_.rend(); ++n) {
        nearRuns_[static_cast<std::size_t>(--firstNearRun_[static_cast<std::size_t>(n->panel)])] = n->run;
    }
}

/// Adds to the targets that have been collected near a panel, and forgets them.
void ChargedWalls::addNearPanel(const Panel& panel, double charge, Points& field, Scalars& potential)
{
    nearPlaces_.finish();
    panel.shape.addField(charge, nearPlaces_);
    addFieldOfPoints(panel.points, -charge, nearPlaces_);
    for (std::size_t n = 0; n < static_cast<std::size_t>(nearPlaces_.count); ++n) {
        field(nearTargets_[n], 0) += nearPlaces_.fieldX[n];
        field(nearTargets_[n], 1) += nearPlaces_.fieldY[n];
        field(nearTargets_[n], 2) += nearPlaces_.fieldZ[n];
        potential[nearTargets_[n]] += nearPlaces_.potential[n];
    }
    nearPlaces_.clear();
}

}  // namespace him
