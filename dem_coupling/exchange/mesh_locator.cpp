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
      anyPeriod_(periodic[0] || periodic[1] || periodic[2]),
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

Vector3 MeshLocator::shiftOfStray(const Vector3& position) const
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
    // What stands there is of the locate() before: few particles leave their cell in a step.
    owner_.resize(static_cast<std::size_t>(rows), -1);
    cell_.resize(static_cast<std::size_t>(rows), -1);
    foreignCentres_.clear();

    // Own cells first; for the rest, ask every rank whose bounds contain the point.
    exchange_.clear(outgoing_);
    for (auto& asked : askedRows_) {
        asked.clear();
    }
    for (Index row = 0; row < rows; ++row) {
        const Vector3 position = positions.row(row).matrix().transpose();
        const Vector3 point = position + shiftIntoBox(position);
        const auto at = static_cast<std::size_t>(row);
        if (isOwn(at) && mesh_.surelyHolds(cell_[at], point)) {
            continue;
        }
        cell_[at] = static_cast<std::int32_t>(mesh_.findCell(point));
        owner_[at] = cell_[at] >= 0 ? exchange_.rank() : -1;
        if (cell_[at] >= 0) {
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
                cell_[static_cast<std::size_t>(row)] = static_cast<std::int32_t>(answer[0]);
                owner_[static_cast<std::size_t>(row)] = static_cast<int>(rank);
                const Vector3 shift = shiftIntoBox(positions.row(row).matrix().transpose());
                foreignCentres_.emplace_back(row, Vector3(answer[1], answer[2], answer[3]) - shift);
            }
        }
    }
}

void MeshLocator::cellCentres(const Points& positions, Points& centres) const
{
    centres = positions;
    for (Index row = 0; row < positions.rows(); ++row) {
        if (isOwn(static_cast<std::size_t>(row))) {
            const Vector3 shift = shiftIntoBox(positions.row(row).matrix().transpose());
            centres.row(row) = (mesh_.cellCentre(cell(row)) - shift).transpose().array();
        }
    }
    for (const auto& [row, centre] : foreignCentres_) {
        centres.row(row) = centre.transpose().array();
    }
}

void MeshLocator::deposit(const Scalars& charge, Scalars& cellCharge)
{
    deposit<1>([&](Index row) { return std::array<double, 1>{charge[row]}; }, depositedCharge_);
    cellCharge = depositedCharge_.col(0);
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
        if (isOwn(row)) {
            values.row(static_cast<Index>(row)) = valueOfCell(cell_[row]).transpose().array();
        }
    }
    takeAnswers(values);
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
        if (isOwn(row)) {
            const auto r = static_cast<Index>(row);
            values.row(r) = valueAt(cell_[row], pointOf(r)).transpose().array();
        }
    }
    takeAnswers(values);
}

}  // namespace him
