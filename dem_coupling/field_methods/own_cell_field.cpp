// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/own_cell_field.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <numeric>

namespace him {

namespace {

constexpr std::size_t probes = 4;

/// Estimates below this share of the surface field are round-off of uniform cells.
constexpr double negligible = 1e-6;

/// Sums over a cell's faces, in units of 4 pi eps = 1.
struct FaceSums {
    double conductance = 0;               // sum A/d
    double drive = 0;                     // sum A/d V_N
    Vector3 own = Vector3::Zero();        // sum S w
    Vector3 neighbour = Vector3::Zero();  // sum S (1 - w) V_N
    bool atEdge = false;

    /// A face with area vector S out of the cell; w is the weight of the cell's own value.
    void add(const Vector3& area, double distance, double weight)
    {
        const double potential = 1 / distance;
        conductance += area.norm() / distance;
        drive += area.norm() / distance * potential;
        own += weight * area;
        neighbour += (1 - weight) * potential * area;
    }
};

struct Candidate {
    double score;
    double radius;
    double tag;
    double owner;
    double cell;
};
static_assert(sizeof(Candidate) == 5 * sizeof(double), "a candidate travels as five doubles");

/// The best rows of this rank, one per cell; filled up with zeros.
std::array<Candidate, probes> bestRows(const Points& uneven, const MeshLocator& locator, const DemParticles& particles)
{
    std::vector<Index> order(static_cast<std::size_t>(particles.size()));
    std::iota(order.begin(), order.end(), Index{0});
    const auto score = [&](Index row) { return uneven(row, 0) * particles.radius[row] * particles.radius[row]; };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return score(a) > score(b); });
    std::array<Candidate, probes> best{};
    std::size_t found = 0;
    for (const Index row : order) {
        if (found == probes || !(score(row) > negligible)) {
            break;
        }
        const Candidate candidate{score(row), particles.radius[row],
                                  static_cast<double>(particles.tag[static_cast<std::size_t>(row)]),
                                  static_cast<double>(locator.owner(row)), static_cast<double>(locator.cell(row))};
        const bool fresh =
            std::none_of(best.begin(), best.begin() + static_cast<long>(found), [&](const Candidate& other) {
                return other.owner == candidate.owner && other.cell == candidate.cell;
            });
        if (fresh) {
            best[found++] = candidate;
        }
    }
    return best;
}

}  // namespace

Scalars unevenness(const MeshArrays& mesh)
{
    std::vector<FaceSums> sums(static_cast<std::size_t>(mesh.cells()));
    const auto at = [](const Points& points, Index row) { return Vector3(points.row(row).matrix().transpose()); };
    for (Index face = 0; face < mesh.internal.size(); ++face) {
        const auto f = static_cast<std::size_t>(face);
        const Vector3 owner = at(mesh.centre, mesh.internal.owner[f]);
        const Vector3 neighbour = at(mesh.centre, mesh.internal.neighbour[f]);
        const Vector3 area = at(mesh.internal.areaVector, face);
        const double distance = (neighbour - owner).norm();
        const double ownersPart = std::abs((at(mesh.internal.centre, face) - owner).dot(area));
        const double neighboursPart = std::abs((at(mesh.internal.centre, face) - neighbour).dot(area));
        const double weight = neighboursPart / (ownersPart + neighboursPart);
        sums[static_cast<std::size_t>(mesh.internal.owner[f])].add(area, distance, weight);
        sums[static_cast<std::size_t>(mesh.internal.neighbour[f])].add(-area, distance, 1 - weight);
    }
    for (Index face = 0; face < mesh.coupled.size(); ++face) {
        // The other side's centre is not here; cells on both sides are taken as alike.
        const auto cell = mesh.coupled.cell[static_cast<std::size_t>(face)];
        const double distance = 2 * (at(mesh.coupled.centre, face) - at(mesh.centre, cell)).norm();
        sums[static_cast<std::size_t>(cell)].add(at(mesh.coupled.areaVector, face), distance, 0.5);
    }
    for (const std::int32_t cell : mesh.boundary.cell) {
        sums[static_cast<std::size_t>(cell)].atEdge = true;
    }
    Scalars result = Scalars::Zero(mesh.cells());
    for (Index cell = 0; cell < mesh.cells(); ++cell) {
        const FaceSums& sum = sums[static_cast<std::size_t>(cell)];
        if (!sum.atEdge && sum.conductance > 0) {
            const double potential = (4 * pi + sum.drive) / sum.conductance;
            result[cell] = (potential * sum.own + sum.neighbour).norm() / mesh.volume[cell];
        }
    }
    return result;
}

OwnCellField probeOwnCellField(PoissonMesh& mesh, MeshLocator& locator, const DemParticles& particles,
                               double permittivity, MPI_Comm communicator)
{
    const Scalars estimate = unevenness(mesh.arrays());
    Points uneven;
    locator.gather([&](Index cell) { return Vector3(estimate[cell], 0, 0); }, uneven);
    const std::array<Candidate, probes> mine = bestRows(uneven, locator, particles);
    int ranks = 1;
    int rank = 0;
    MPI_Comm_size(communicator, &ranks);
    MPI_Comm_rank(communicator, &rank);
    std::vector<Candidate> all(probes * static_cast<std::size_t>(ranks));
    constexpr int doubles = static_cast<int>(probes * sizeof(Candidate) / sizeof(double));
    MPI_Allgather(mine.data(), doubles, MPI_DOUBLE, all.data(), doubles, MPI_DOUBLE, communicator);
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.score > b.score; });

    OwnCellField largest;
    const auto kept = mesh.keep();
    // One coulomb: beside its field that of any electrode vanishes.
    Scalars charge;
    for (std::size_t n = 0; n < probes && all[n].score > 0; ++n) {
        const auto cell = static_cast<Index>(all[n].cell);
        const int owner = static_cast<int>(all[n].owner);
        charge.setZero(mesh.cellCount());
        if (rank == owner) {
            charge[cell] = 1;
        }
        mesh.solve(charge);
        double field = rank == owner ? mesh.electricField(cell).norm() : 0;
        MPI_Bcast(&field, 1, MPI_DOUBLE, owner, communicator);
        const double share = field * 4 * pi * permittivity * all[n].radius * all[n].radius;
        if (share > largest.share) {
            largest = {share, static_cast<int>(all[n].tag)};
        }
    }
    if (kept) {
        mesh.restore(kept.get());
    }
    return largest;
}

}  // namespace him
