// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/own_response_table.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>

namespace him {

namespace {

/// A solve takes about 1 us per cell, so this many are made in a minute or two.
constexpr std::int64_t mostCells = 10000;
constexpr double mostBytes = 4e8;  ///< on each rank

/// Consecutive numbers over all ranks for the first `own` of all rows. Collective.
/// @return the number of this rank's first row
std::int64_t numberRows(Index own, MPI_Comm communicator, std::int64_t& all)
{
    const std::int64_t mine = own;
    std::int64_t upTo = 0;
    MPI_Scan(&mine, &upTo, 1, MPI_INT64_T, MPI_SUM, communicator);
    MPI_Allreduce(&mine, &all, 1, MPI_INT64_T, MPI_SUM, communicator);
    return upTo - mine;
}

std::vector<std::int64_t> toNumbers(const Scalars& values)
{
    std::vector<std::int64_t> numbers;
    for (const double value : values) {
        numbers.push_back(static_cast<std::int64_t>(value));
    }
    return numbers;
}

/// Every number that some rank asks for, once, in ascending order; the same on all ranks. Collective.
std::vector<std::int64_t> askedByAny(std::vector<std::int64_t> mine, MPI_Comm communicator)
{
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    std::vector<int> counts(static_cast<std::size_t>(ranks)), first(static_cast<std::size_t>(ranks), 0);
    const int count = static_cast<int>(mine.size());
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t rank = 1; rank < first.size(); ++rank) {
        first[rank] = first[rank - 1] + counts[rank - 1];
    }
    std::vector<std::int64_t> all(static_cast<std::size_t>(first.back() + counts.back()));
    MPI_Allgatherv(mine.data(), count, MPI_INT64_T, all.data(), counts.data(), first.data(), MPI_INT64_T, communicator);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

/// Calls visit(cell) for the cells around a cell, in the order of depositOne().
template <class Visit> void forCells(const Surroundings& around, const Visit& visit)
{
    for (const RowRange& range : around.cells) {
        for (Index cell = range.begin; cell < range.end; ++cell) {
            visit(cell);
        }
    }
}

}  // namespace

bool OwnResponseTable::fits(const LocalMesh& mesh, SurroundingsTable& table, int order, MPI_Comm communicator)
{
    std::int64_t cells = mesh.ownCells;
    MPI_Allreduce(MPI_IN_PLACE, &cells, 1, MPI_INT64_T, MPI_SUM, communicator);
    if (cells > mostCells) {
        return false;
    }
    double bytes = 0;
    for (Index cell = 0; cell < mesh.ownCells; ++cell) {
        bytes += static_cast<double>(table.of(cell).count) * width(order) * sizeof(float);
    }
    MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_MAX, communicator);
    return bytes <= mostBytes;
}

OwnResponseTable::OwnResponseTable(PoissonMesh& mesh, MeshHalo& halo, SurroundingsTable& table,
                                   PolynomialGather& gather, int order, MPI_Comm communicator)
    : mesh_(mesh), halo_(halo), table_(table), gather_(gather), width_(width(order)), communicator_(communicator)
{
    const LocalMesh& local = halo.mesh();
    std::int64_t cells = 0;
    std::int64_t faces = 0;
    firstCell_ = numberRows(local.ownCells, communicator, cells);
    firstFace_ = numberRows(local.ownFaces, communicator, faces);
    cellSolved_.assign(static_cast<std::size_t>(cells), false);
    faceSolved_.assign(static_cast<std::size_t>(faces), false);
    const auto first = [](std::int64_t number, Index rows) {
        return static_cast<double>(number) + Scalars::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
    };
    Scalars numbers = first(firstCell_, local.ownCells);
    halo.forwardCells(numbers);
    cellNumber_ = toNumbers(numbers);
    numbers = first(firstFace_, local.ownFaces);
    halo.forwardFaces(numbers);
    faceNumber_ = toNumbers(numbers);
    prepareHosts();
}

void OwnResponseTable::prepareHosts()
{
    hosts_.resize(static_cast<std::size_t>(halo_.mesh().ownCells));
    for (std::size_t h = 0; h < hosts_.size(); ++h) {
        const Surroundings& around = table_.of(static_cast<Index>(h));
        Host& host = hosts_[h];
        host.faces = around.unmirrored;
        host.faces.insert(host.faces.end(), around.unmirroredCopies.begin(), around.unmirroredCopies.end());
        std::int32_t column = 0;
        forCells(around, [&](Index cell) {
            cellUses_.push_back(
                {cellNumber_[static_cast<std::size_t>(cell)], {static_cast<std::int32_t>(h), column++}});
        });
        column = 0;
        for (const std::int32_t face : host.faces) {
            faceUses_.push_back(
                {faceNumber_[static_cast<std::size_t>(face)], {static_cast<std::int32_t>(h), column++}});
        }
    }
    const auto bySource = [](const Use& a, const Use& b) { return a.source < b.source; };
    std::stable_sort(cellUses_.begin(), cellUses_.end(), bySource);
    std::stable_sort(faceUses_.begin(), faceUses_.end(), bySource);
}

void OwnResponseTable::extend(const CloudSources& sources, const Solve& solve)
{
    std::vector<std::int64_t> cells, faces;
    for (Index target = 0; target < sources.targets; ++target) {
        const auto h = static_cast<std::size_t>(sources.cell[static_cast<std::size_t>(target)]);
        if (hosts_[h].known) {
            continue;
        }
        hosts_[h].known = true;
        forCells(table_.of(static_cast<Index>(h)), [&](Index cell) {
            const std::int64_t number = cellNumber_[static_cast<std::size_t>(cell)];
            if (!cellSolved_[static_cast<std::size_t>(number)]) {
                cells.push_back(number);
            }
        });
        for (const std::int32_t face : hosts_[h].faces) {
            const std::int64_t number = faceNumber_[static_cast<std::size_t>(face)];
            if (!faceSolved_[static_cast<std::size_t>(number)]) {
                faces.push_back(number);
            }
        }
    }
    cells = askedByAny(std::move(cells), communicator_);
    faces = askedByAny(std::move(faces), communicator_);
    if (cells.empty() && faces.empty()) {
        return;
    }
    const auto kept = mesh_.keep();
    for (const std::int64_t cell : cells) {
        solveFor(cell, false, solve);
        cellSolved_[static_cast<std::size_t>(cell)] = true;
    }
    for (const std::int64_t face : faces) {
        solveFor(face, true, solve);
        faceSolved_[static_cast<std::size_t>(face)] = true;
    }
    if (kept) {
        mesh_.restore(kept.get());
    }
}

void OwnResponseTable::solveFor(std::int64_t source, bool isFace, const Solve& solve)
{
    const LocalMesh& local = halo_.mesh();
    charge_.setZero(local.ownCells);
    faceValue_.setZero(local.ownFaces);
    Scalars& sources = isFace ? faceValue_ : charge_;
    const std::int64_t row = source - (isFace ? firstFace_ : firstCell_);
    if (row >= 0 && row < sources.size()) {
        sources[row] = 1;
    }
    mesh_.forgetPotential();
    solve(charge_, faceValue_, potential_);
    const std::vector<Use>& uses = isFace ? faceUses_ : cellUses_;
    const auto [from, to] = std::equal_range(uses.begin(), uses.end(), Use{source, {0, 0}},
                                             [](const Use& a, const Use& b) { return a.source < b.source; });
    for (auto use = from; use != to; ++use) {
        Host& host = hosts_[static_cast<std::size_t>(use->place.host)];
        gather_.fit(use->place.host, potential_, faceValue_, fitted_);
        std::vector<float>& answers = isFace ? host.ofFaces : host.ofCells;
        if (answers.empty()) {
            const auto columns =
                isFace ? host.faces.size() : static_cast<std::size_t>(table_.of(use->place.host).count);
            answers.assign(columns * static_cast<std::size_t>(width_), 0.0F);
            host.frame = fitted_;
        }
        std::transform(fitted_.coefficients.begin(), fitted_.coefficients.begin() + width_,
                       answers.begin() + static_cast<std::ptrdiff_t>(use->place.column) * width_,
                       [](double coefficient) { return static_cast<float>(coefficient); });
    }
}

Vector3 OwnResponseTable::gradient(const CloudSources& sources, Index target, const Scalars& charge,
                                   const ChargeCloud& cloud, double permittivity)
{
    const Host& host = hosts_[static_cast<std::size_t>(sources.cell[static_cast<std::size_t>(target)])];
    fitted_ = host.frame;
    fitted_.coefficients.fill(0.0);
    const auto add = [&](double amount, const std::vector<float>& answers, Index column) {
        if (amount == 0) {
            return;
        }
        const float* answer = answers.data() + column * width_;
        for (int k = 0; k < width_; ++k) {
            fitted_.coefficients[static_cast<std::size_t>(k)] += amount * static_cast<double>(answer[k]);
        }
    };
    for (Index n = 0; n < charge.size(); ++n) {
        add(charge[n], host.ofCells, n);
    }
    const double coulombConstant = 1.0 / (4.0 * pi * permittivity);
    for (std::size_t n = 0; n < host.faces.size(); ++n) {
        add(coulombConstant * sources.wallValue(target, halo_.mesh().boundary, host.faces[n], cloud), host.ofFaces,
            static_cast<Index>(n));
    }
    double value = 0;
    Vector3 result;
    fitted_.evaluate(sources.position.row(target).matrix().transpose(), value, result);
    return result;
}

}  // namespace him
