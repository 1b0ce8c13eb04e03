// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/mesh_locator.hpp"

#include <cmath>

namespace him {

MeshLocator::MeshLocator(const CellMesh& mesh, MPI_Comm communicator)
    : MeshLocator(mesh, communicator, Box(), {false, false, false})
{
}

MeshLocator::MeshLocator(const CellMesh& mesh, MPI_Comm communicator, const Box& demBox,
                         const std::array<bool, 3>& periodic)
    : mesh_(mesh),
      demBox_(demBox),
      periodic_(periodic),
      exchange_(communicator),
      bounds_(static_cast<std::size_t>(exchange_.ranks())),
      askedRows_(static_cast<std::size_t>(exchange_.ranks())),
      answeredCells_(static_cast<std::size_t>(exchange_.ranks()))
{
    const Box bounds = mesh_.localBounds();
    const Box own = bounds.empty() ? bounds : bounds.grownBy(1e-9 * bounds.size().norm());
    static_assert(sizeof(Box) == 6 * sizeof(double), "a box travels as six doubles");
    MPI_Allgather(own.lower.data(), 6, MPI_DOUBLE, bounds_.data(), 6, MPI_DOUBLE, communicator);
}

Vector3 MeshLocator::shiftIntoBox(const Vector3& position) const
{
    Vector3 shift = Vector3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        const bool stray = position[axis] < demBox_.lower[axis] || position[axis] > demBox_.upper[axis];
        if (periodic_[static_cast<std::size_t>(axis)] && stray) {
            const double period = demBox_.size()[axis];
            shift[axis] = -period * std::floor((position[axis] - demBox_.lower[axis]) / period);
        }
    }
    return shift;
}

void MeshLocator::locate(const Points& positions)
{
    const Index rows = positions.rows();
    owner_.assign(static_cast<std::size_t>(rows), -1);
    cellBefore_.swap(cell_);
    cellBefore_.resize(static_cast<std::size_t>(rows), -1);
    cell_.assign(static_cast<std::size_t>(rows), -1);
    ownersCell_.assign(static_cast<std::size_t>(rows), -1);
    cellCentre_ = positions;

    // Own cells first; for the rest, ask every rank whose bounds contain the point.
    exchange_.clear(outgoing_);
    for (auto& asked : askedRows_) {
        asked.clear();
    }
    for (Index row = 0; row < rows; ++row) {
        const Vector3 position = positions.row(row).matrix().transpose();
        const Vector3 shift = shiftIntoBox(position);
        const Vector3 point = position + shift;
        const Index before = cellBefore_[static_cast<std::size_t>(row)];
        const Index cell = before >= 0 && mesh_.surelyHolds(before, point) ? before : mesh_.findCell(point);
        if (cell >= 0) {
            owner_[static_cast<std::size_t>(row)] = exchange_.rank();
            cell_[static_cast<std::size_t>(row)] = cell;
            ownersCell_[static_cast<std::size_t>(row)] = cell;
            cellCentre_.row(row) = (mesh_.cellCentre(cell) - shift).transpose().array();
            continue;
        }
        for (int rank = 0; rank < exchange_.ranks(); ++rank) {
            const auto r = static_cast<std::size_t>(rank);
            if (rank != exchange_.rank() && bounds_[r].contains(point)) {
                askedRows_[r].push_back(row);
                outgoing_[r].insert(outgoing_[r].end(), {point[0], point[1], point[2]});
            }
        }
    }
    exchange_.exchange(outgoing_, incoming_);

    // Answer with the cell's number, -1 where there is none, and its centre.
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < incoming_.size(); ++rank) {
        answeredCells_[rank].clear();
        for (std::size_t at = 0; at < incoming_[rank].size(); at += 3) {
            const Vector3 point(incoming_[rank][at], incoming_[rank][at + 1], incoming_[rank][at + 2]);
            const Index cell = mesh_.findCell(point);
            const Vector3 centre = cell >= 0 ? mesh_.cellCentre(cell) : point;
            answeredCells_[rank].push_back(cell);
            outgoing_[rank].insert(outgoing_[rank].end(), {static_cast<double>(cell), centre[0], centre[1], centre[2]});
        }
        incoming_[rank].resize(4 * askedRows_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);

    for (std::size_t rank = 0; rank < incoming_.size(); ++rank) {
        for (std::size_t n = 0; n < askedRows_[rank].size(); ++n) {
            const Index row = askedRows_[rank][n];
            const double* answer = incoming_[rank].data() + 4 * n;
            if (answer[0] >= 0 && !inMesh(row)) {
                ownersCell_[static_cast<std::size_t>(row)] = static_cast<Index>(answer[0]);
                owner_[static_cast<std::size_t>(row)] = static_cast<int>(rank);
                const Vector3 centre(answer[1], answer[2], answer[3]);
                const Vector3 shift = shiftIntoBox(positions.row(row).matrix().transpose());
                cellCentre_.row(row) = (centre - shift).transpose().array();
            }
        }
    }
}

void MeshLocator::deposit(const Scalars& charge, Scalars& cellCharge)
{
    cellCharge.resize(mesh_.cellCount());
    addToCells(charge, cellCharge);
}

void MeshLocator::deposit(const Eigen::Ref<const Eigen::ArrayXXd>& ofRow, Eigen::ArrayXXd& ofCell)
{
    ofCell.resize(mesh_.cellCount(), ofRow.cols());
    addToCells(ofRow, ofCell);
}

void MeshLocator::addToCells(const Eigen::Ref<const Eigen::ArrayXXd>& ofRow, Eigen::Ref<Eigen::ArrayXXd> ofCell)
{
    const Index columns = ofRow.cols();
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < askedRows_.size(); ++rank) {
        for (const Index row : askedRows_[rank]) {
            const bool taker = owner_[static_cast<std::size_t>(row)] == static_cast<int>(rank);
            for (Index k = 0; k < columns; ++k) {
                outgoing_[rank].push_back(taker ? ofRow(row, k) : 0.0);
            }
        }
        incoming_[rank].resize(static_cast<std::size_t>(columns) * answeredCells_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);

    ofCell.setZero();
    for (Index k = 0; k < columns; ++k) {
        for (std::size_t row = 0; row < cell_.size(); ++row) {
            if (cell_[row] >= 0) {
                ofCell(cell_[row], k) += ofRow(static_cast<Index>(row), k);
            }
        }
    }
    for (std::size_t rank = 0; rank < answeredCells_.size(); ++rank) {
        const double* in = incoming_[rank].data();
        for (const Index cell : answeredCells_[rank]) {
            for (Index k = 0; k < columns; ++k, ++in) {
                if (cell >= 0) {
                    ofCell(cell, k) += *in;
                }
            }
        }
    }
}

void MeshLocator::answerVectors(const std::function<Vector3(std::size_t, std::size_t)>& valueOfAnswer)
{
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < answeredCells_.size(); ++rank) {
        for (std::size_t n = 0; n < answeredCells_[rank].size(); ++n) {
            const Vector3 value = answeredCells_[rank][n] >= 0 ? valueOfAnswer(rank, n) : Vector3::Zero().eval();
            outgoing_[rank].insert(outgoing_[rank].end(), {value[0], value[1], value[2]});
        }
        incoming_[rank].resize(3 * askedRows_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);
}

void MeshLocator::takeAnswers(Points& values) const
{
    for (std::size_t rank = 0; rank < askedRows_.size(); ++rank) {
        for (std::size_t n = 0; n < askedRows_[rank].size(); ++n) {
            const Index row = askedRows_[rank][n];
            if (owner_[static_cast<std::size_t>(row)] == static_cast<int>(rank)) {
                const double* value = incoming_[rank].data() + 3 * n;
                values.row(row) << value[0], value[1], value[2];
            }
        }
    }
}

void MeshLocator::gather(const std::function<Vector3(Index)>& valueOfCell, Points& values)
{
    answerVectors([&](std::size_t rank, std::size_t n) { return valueOfCell(answeredCells_[rank][n]); });
    values.setZero(static_cast<Index>(owner_.size()), 3);
    for (std::size_t row = 0; row < cell_.size(); ++row) {
        if (cell_[row] >= 0) {
            values.row(static_cast<Index>(row)) = valueOfCell(cell_[row]).transpose().array();
        }
    }
    takeAnswers(values);
}

void MeshLocator::gather(const Eigen::ArrayXXd& ofCell, Eigen::Ref<Eigen::ArrayXXd> ofRow)
{
    const Index columns = ofCell.cols();
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < answeredCells_.size(); ++rank) {
        for (const Index cell : answeredCells_[rank]) {
            for (Index k = 0; k < columns; ++k) {
                outgoing_[rank].push_back(cell >= 0 ? ofCell(cell, k) : 0.0);
            }
        }
        incoming_[rank].resize(static_cast<std::size_t>(columns) * askedRows_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);
    for (Index k = 0; k < columns; ++k) {
        for (std::size_t row = 0; row < cell_.size(); ++row) {
            ofRow(static_cast<Index>(row), k) = cell_[row] >= 0 ? ofCell(cell_[row], k) : 0.0;
        }
    }
    for (std::size_t rank = 0; rank < askedRows_.size(); ++rank) {
        const double* in = incoming_[rank].data();
        for (const Index row : askedRows_[rank]) {
            const bool answers = owner_[static_cast<std::size_t>(row)] == static_cast<int>(rank);
            for (Index k = 0; k < columns; ++k, ++in) {
                if (answers) {
                    ofRow(row, k) = *in;
                }
            }
        }
    }
}

void MeshLocator::gather(const Points& positions, const std::function<Vector3(Index, const Vector3&)>& valueAt,
                         Points& values)
{
    const auto pointOf = [&](Index row) -> Vector3 {
        const Vector3 position = positions.row(row).matrix().transpose();
        return position + shiftIntoBox(position);
    };
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < askedRows_.size(); ++rank) {
        for (const Index row : askedRows_[rank]) {
            const Vector3 point = pointOf(row);
            outgoing_[rank].insert(outgoing_[rank].end(), {point[0], point[1], point[2]});
        }
        incoming_[rank].resize(3 * answeredCells_[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);
    asked_.swap(incoming_);
    incoming_.resize(asked_.size());

    answerVectors([&](std::size_t rank, std::size_t n) {
        return valueAt(answeredCells_[rank][n], Vector3(asked_[rank].data() + 3 * n));
    });
    values.setZero(static_cast<Index>(owner_.size()), 3);
    for (std::size_t row = 0; row < cell_.size(); ++row) {
        if (cell_[row] >= 0) {
            const auto r = static_cast<Index>(row);
            values.row(r) = valueAt(cell_[row], pointOf(r)).transpose().array();
        }
    }
    takeAnswers(values);
}

}  // namespace him
