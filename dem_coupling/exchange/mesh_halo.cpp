// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/mesh_halo.hpp"

#include <array>
#include <cmath>
#include <map>

namespace him {

namespace {

/// A cell anywhere: rank, number there, and by how many quanta of length its copy is shifted. Shifts are sums of periods
/// along different ways; rounding them to quanta makes equal ones equal.
using Key = std::array<std::int64_t, 5>;

Box boundsOf(const Points& points)
{
    Box box;
    if (points.rows() > 0) {
        box.lower = points.colwise().minCoeff().transpose();
        box.upper = points.colwise().maxCoeff().transpose();
    }
    return box;
}

/// Everything that another rank must know of one of this rank's cells to go on walking from it, as doubles.
struct CellRecords {
    IndexLists neighbours;  ///< over internal faces
    IndexLists coupled;     ///< coupled faces of each cell
    IndexLists boundary;    ///< boundary faces of each cell

    explicit CellRecords(const MeshArrays& mesh);
};

IndexLists sortedByCell(Index cells, const std::vector<std::int32_t>& cellOf)
{
    IndexLists lists;
    lists.first.assign(static_cast<std::size_t>(cells) + 1, 0);
    for (const std::int32_t cell : cellOf) {
        ++lists.first[static_cast<std::size_t>(cell) + 1];
    }
    for (std::size_t cell = 1; cell < lists.first.size(); ++cell) {
        lists.first[cell] += lists.first[cell - 1];
    }
    lists.entries.resize(cellOf.size());
    std::vector<std::int32_t> next(lists.first.begin(), lists.first.end() - 1);
    for (std::size_t n = 0; n < cellOf.size(); ++n) {
        lists.entries[static_cast<std::size_t>(next[static_cast<std::size_t>(cellOf[n])]++)] =
            static_cast<std::int32_t>(n);
    }
    return lists;
}

CellRecords::CellRecords(const MeshArrays& mesh)
{
    std::vector<std::int32_t> from(mesh.internal.owner);
    from.insert(from.end(), mesh.internal.neighbour.begin(), mesh.internal.neighbour.end());
    std::vector<std::int32_t> to(mesh.internal.neighbour);
    to.insert(to.end(), mesh.internal.owner.begin(), mesh.internal.owner.end());
    neighbours = sortedByCell(mesh.cells(), from);
    for (std::int32_t& entry : neighbours.entries) {
        entry = to[static_cast<std::size_t>(entry)];
    }
    coupled = sortedByCell(mesh.cells(), mesh.coupled.cell);
    boundary = sortedByCell(mesh.cells(), mesh.boundary.cell);
}

/// Step from a cell to a neighbour: rank, cell, shift.
struct Step {
    std::int32_t rank;
    std::int32_t cell;
    Vector3 shift;
};

/// A cell as it is learnt, not yet shifted.
struct Learnt {
    Vector3 centre;
    double volume = 0;
    double radius = 0;
    std::vector<Step> steps;
    Index faces = 0;
    std::vector<double> faceData;  ///< facePayload values per boundary face
};

constexpr std::size_t facePayload = 11;  // centre, normal, area, radius, value, condition, number at its rank

void pack(const MeshArrays& mesh, const CellRecords& records, int rank, Index cell, std::vector<double>& out)
{
    const Vector3 centre = mesh.centre.row(cell).matrix().transpose();
    const auto neighbours = records.neighbours[cell];
    const auto coupled = records.coupled[cell];
    const auto faces = records.boundary[cell];
    out.insert(out.end(),
               {centre[0], centre[1], centre[2], mesh.volume[cell], mesh.radius[cell],
                static_cast<double>((neighbours.end() - neighbours.begin()) + (coupled.end() - coupled.begin())),
                static_cast<double>(faces.end() - faces.begin())});
    for (const std::int32_t neighbour : neighbours) {
        out.insert(out.end(), {static_cast<double>(rank), static_cast<double>(neighbour), 0, 0, 0});
    }
    for (const std::int32_t face : coupled) {
        const auto f = static_cast<std::size_t>(face);
        out.insert(out.end(),
                   {static_cast<double>(mesh.coupled.otherRank[f]), static_cast<double>(mesh.coupled.otherCell[f]),
                    mesh.coupled.shift(face, 0), mesh.coupled.shift(face, 1), mesh.coupled.shift(face, 2)});
    }
    const BoundaryFaces& b = mesh.boundary;
    for (const std::int32_t face : faces) {
        out.insert(out.end(),
                   {b.centre(face, 0), b.centre(face, 1), b.centre(face, 2), b.normal(face, 0), b.normal(face, 1),
                    b.normal(face, 2), b.area[face], b.radius[face], b.value[face],
                    static_cast<double>(b.condition[static_cast<std::size_t>(face)]), static_cast<double>(face)});
    }
}

Learnt unpack(const double*& in)
{
    Learnt cell;
    cell.centre = {in[0], in[1], in[2]};
    cell.volume = in[3];
    cell.radius = in[4];
    const auto steps = static_cast<std::size_t>(in[5]);
    cell.faces = static_cast<Index>(in[6]);
    in += 7;
    for (std::size_t n = 0; n < steps; ++n, in += 5) {
        cell.steps.push_back(
            {static_cast<std::int32_t>(in[0]), static_cast<std::int32_t>(in[1]), {in[2], in[3], in[4]}});
    }
    cell.faceData.assign(in, in + facePayload * static_cast<std::size_t>(cell.faces));
    in += facePayload * static_cast<std::size_t>(cell.faces);
    return cell;
}

}  // namespace

MeshHalo::MeshHalo(const MeshArrays& mesh, double reach, int layers, MPI_Comm communicator)
    : exchange_(communicator), bounds_(static_cast<std::size_t>(exchange_.ranks()))
{
    const int self = exchange_.rank();
    const Box own = boundsOf(mesh.centre);
    static_assert(sizeof(Box) == 6 * sizeof(double), "a box travels as six doubles");
    MPI_Allgather(own.lower.data(), 6, MPI_DOUBLE, bounds_.data(), 6, MPI_DOUBLE, communicator);
    const CellRecords records(mesh);

    double quantum = mesh.cells() > 0 ? 1e-4 * std::cbrt(mesh.volume.minCoeff()) : 1.0;
    MPI_Allreduce(MPI_IN_PLACE, &quantum, 1, MPI_DOUBLE, MPI_MIN, communicator);
    const auto keyOf = [quantum](std::int32_t rank, std::int32_t cell, const Vector3& shift) {
        return Key{rank, cell, std::llround(shift[0] / quantum), std::llround(shift[1] / quantum),
                   std::llround(shift[2] / quantum)};
    };

    // Walk outwards, one layer of cells at a time. Every rank takes part in every round until nobody has a cell to ask for.
    std::map<Key, std::int32_t> numberOf;  // of the copies
    std::vector<Copy> copies;
    std::vector<Learnt> learnt;
    std::vector<Step> front;
    for (Index face = 0; face < mesh.coupled.size(); ++face) {
        const auto f = static_cast<std::size_t>(face);
        front.push_back(
            {mesh.coupled.otherRank[f], mesh.coupled.otherCell[f], mesh.coupled.shift.row(face).matrix().transpose()});
    }
    const auto isOwn = [self](const Key& key) { return key[0] == self && key[2] == 0 && key[3] == 0 && key[4] == 0; };
    SparseExchange::Buffers asked, answers;
    for (int layer = 1;; ++layer) {
        std::map<Key, Step> wanted;
        for (const Step& step : front) {
            const Key key = keyOf(step.rank, step.cell, step.shift);
            if (!isOwn(key) && numberOf.find(key) == numberOf.end()) {
                wanted.emplace(key, step);
            }
        }
        front.clear();
        std::int64_t open = static_cast<std::int64_t>(wanted.size());
        MPI_Allreduce(MPI_IN_PLACE, &open, 1, MPI_INT64_T, MPI_SUM, communicator);
        if (open == 0) {
            break;
        }
        exchange_.clear(outgoing_);
        std::vector<std::vector<Step>> order(static_cast<std::size_t>(exchange_.ranks()));
        for (const auto& [key, step] : wanted) {
            outgoing_[static_cast<std::size_t>(step.rank)].push_back(step.cell);
            order[static_cast<std::size_t>(step.rank)].push_back(step);
        }
        exchange_.exchange(outgoing_, asked);
        exchange_.clear(outgoing_);
        for (std::size_t rank = 0; rank < asked.size(); ++rank) {
            for (const double cell : asked[rank]) {
                pack(mesh, records, self, static_cast<Index>(cell), outgoing_[rank]);
            }
        }
        exchange_.exchange(outgoing_, answers);
        for (std::size_t rank = 0; rank < answers.size(); ++rank) {
            const double* in = answers[rank].data();
            for (const Step& step : order[rank]) {
                Learnt cell = unpack(in);
                const bool near = own.squaredDistance(cell.centre + step.shift) <= reach * reach;
                if (!near && layer > layers) {
                    continue;
                }
                numberOf.emplace(keyOf(step.rank, step.cell, step.shift),
                                 static_cast<std::int32_t>(mesh.cells()) + static_cast<std::int32_t>(copies.size()));
                copies.push_back({step.rank, step.cell, step.shift});
                for (Step& next : cell.steps) {
                    next.shift += step.shift;
                    front.push_back(next);
                }
                learnt.push_back(std::move(cell));
            }
        }
    }

    // The local mesh: own cells as they are, then the copies.
    const auto ownCells = mesh.cells();
    const auto all = ownCells + static_cast<Index>(copies.size());
    local_.ownCells = ownCells;
    local_.centre.resize(all, 3);
    local_.centre.topRows(ownCells) = mesh.centre;
    local_.volume.resize(all);
    local_.volume.head(ownCells) = mesh.volume;
    local_.radius.resize(all);
    local_.radius.head(ownCells) = mesh.radius;
    local_.boundary = mesh.boundary;
    local_.ownFaces = mesh.boundary.size();
    Index faces = local_.ownFaces;
    for (const Learnt& cell : learnt) {
        faces += cell.faces;
    }
    BoundaryFaces& b = local_.boundary;
    b.centre.conservativeResize(faces, 3);
    b.normal.conservativeResize(faces, 3);
    for (Scalars* values : {&b.area, &b.radius, &b.value}) {
        values->conservativeResize(faces);
    }
    const auto numberAt = [&](const Key& key) -> std::int32_t {
        if (isOwn(key)) {
            return static_cast<std::int32_t>(key[1]);
        }
        const auto found = numberOf.find(key);
        return found == numberOf.end() ? -1 : found->second;
    };
    for (Index cell = 0; cell < ownCells; ++cell) {
        for (const std::int32_t neighbour : records.neighbours[cell]) {
            local_.neighbours.entries.push_back(neighbour);
        }
        for (const std::int32_t face : records.coupled[cell]) {
            const auto f = static_cast<std::size_t>(face);
            local_.neighbours.entries.push_back(numberAt(keyOf(mesh.coupled.otherRank[f], mesh.coupled.otherCell[f],
                                                               mesh.coupled.shift.row(face).matrix().transpose())));
        }
        local_.neighbours.closeRow();
    }
    receivedCells_.resize(bounds_.size());
    receivedFaces_.resize(bounds_.size());
    std::vector<std::vector<std::int32_t>> askedFaces(bounds_.size());
    Index face = local_.ownFaces;
    exchange_.clear(outgoing_);
    for (std::size_t n = 0; n < copies.size(); ++n) {
        const Copy& copy = copies[n];
        const Learnt& cell = learnt[n];
        const Index number = ownCells + static_cast<Index>(n);
        local_.centre.row(number) = (cell.centre + copy.shift).transpose().array();
        local_.volume[number] = cell.volume;
        local_.radius[number] = cell.radius;
        for (const Step& step : cell.steps) {
            const std::int32_t neighbour = numberAt(keyOf(step.rank, step.cell, step.shift));
            if (neighbour >= 0) {
                local_.neighbours.entries.push_back(neighbour);
            }
        }
        local_.neighbours.closeRow();
        const auto r = static_cast<std::size_t>(copy.rank);
        receivedCells_[r].push_back(static_cast<std::int32_t>(number));
        outgoing_[r].insert(outgoing_[r].end(), {static_cast<double>(copy.cell), static_cast<double>(number),
                                                 copy.shift[0], copy.shift[1], copy.shift[2]});
        for (std::size_t k = 0; k < cell.faceData.size(); k += facePayload, ++face) {
            const double* d = cell.faceData.data() + k;
            b.centre.row(face) << d[0] + copy.shift[0], d[1] + copy.shift[1], d[2] + copy.shift[2];
            b.normal.row(face) << d[3], d[4], d[5];
            b.area[face] = d[6];
            b.radius[face] = d[7];
            b.value[face] = d[8];
            b.condition.push_back(static_cast<FaceCondition>(static_cast<int>(d[9])));
            b.cell.push_back(static_cast<std::int32_t>(number));
            receivedFaces_[r].push_back(static_cast<std::int32_t>(face));
            askedFaces[r].push_back(static_cast<std::int32_t>(d[10]));
        }
    }
    local_.facesOfCell = sortedByCell(all, b.cell);

    // Tell every rank which of its cells and faces have copies here.
    exchange_.exchange(outgoing_, incoming_);
    sentCells_.resize(bounds_.size());
    sentFaces_.resize(bounds_.size());
    std::vector<Holder> unsorted;
    std::vector<std::int32_t> cellOfHolder;
    for (std::size_t rank = 0; rank < incoming_.size(); ++rank) {
        for (std::size_t at = 0; at < incoming_[rank].size(); at += 5) {
            const double* in = incoming_[rank].data() + at;
            const auto cell = static_cast<std::int32_t>(in[0]);
            sentCells_[rank].push_back(cell);
            unsorted.push_back(
                {static_cast<std::int32_t>(rank), static_cast<std::int32_t>(in[1]), {in[2], in[3], in[4]}});
            cellOfHolder.push_back(cell);
        }
    }
    const IndexLists byCell = sortedByCell(ownCells, cellOfHolder);
    firstHolder_.assign(byCell.first.begin(), byCell.first.end());
    for (const std::int32_t n : byCell.entries) {
        holders_.push_back(unsorted[static_cast<std::size_t>(n)]);
    }
    exchange_.clear(outgoing_);
    for (std::size_t rank = 0; rank < askedFaces.size(); ++rank) {
        outgoing_[rank].assign(askedFaces[rank].begin(), askedFaces[rank].end());
    }
    exchange_.exchange(outgoing_, incoming_);
    for (std::size_t rank = 0; rank < incoming_.size(); ++rank) {
        for (const double value : incoming_[rank]) {
            sentFaces_[rank].push_back(static_cast<std::int32_t>(value));
        }
    }
}

void MeshHalo::forward(const std::vector<std::vector<std::int32_t>>& sent,
                       const std::vector<std::vector<std::int32_t>>& received, Index own, Index all, Scalars& values)
{
    exchange_.clear(outgoing_);
    exchange_.clear(incoming_);
    for (std::size_t rank = 0; rank < sent.size(); ++rank) {
        for (const std::int32_t row : sent[rank]) {
            outgoing_[rank].push_back(values[row]);
        }
        incoming_[rank].resize(received[rank].size());
    }
    exchange_.answer(outgoing_, incoming_);
    if (values.size() != all) {
        const Scalars kept = values.head(own);
        values.resize(all);
        values.head(own) = kept;
    }
    for (std::size_t rank = 0; rank < received.size(); ++rank) {
        for (std::size_t n = 0; n < received[rank].size(); ++n) {
            values[received[rank][n]] = incoming_[rank][n];
        }
    }
}

void MeshHalo::forwardCells(Scalars& values)
{
    forward(sentCells_, receivedCells_, local_.ownCells, local_.cells(), values);
}

void MeshHalo::forwardFaces(Scalars& values)
{
    forward(sentFaces_, receivedFaces_, local_.ownFaces, local_.boundary.size(), values);
}

}  // namespace him
