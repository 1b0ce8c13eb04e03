// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/particle_sets.hpp"

#include <random>
#include <stdexcept>

namespace him {

DemParticles emptyParticles(int count)
{
    DemParticles particles;
    particles.tag.resize(static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n) {
        particles.tag[static_cast<std::size_t>(n)] = n + 1;
    }
    particles.type.assign(static_cast<std::size_t>(count), 1);
    particles.position.setZero(count, 3);
    particles.velocity.setZero(count, 3);
    particles.charge.setZero(count);
    particles.radius.setConstant(count, 1e-3);
    particles.mass.setConstant(count, 1e-6);
    return particles;
}

DemParticles randomParticles(int count, const Box& box, double diameter, double charge, Charges charges, std::uint32_t seed)
{
    std::mt19937 random(seed);
    const auto unit = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
    DemParticles particles = emptyParticles(count);
    particles.radius.setConstant(0.5 * diameter);
    Index row = 0;
    for (int attempt = 0; row < count; ++attempt) {
        if (attempt > 1000 * count) {
            throw std::runtime_error("randomParticles: the box is too full");
        }
        const Vector3 point = box.lower + Vector3(unit(), unit(), unit()).cwiseProduct(box.size());
        const auto gaps = (particles.position.topRows(row).rowwise() - point.transpose().array()).square().rowwise().sum();
        if (row > 0 && gaps.minCoeff() < diameter * diameter) {
            continue;
        }
        particles.position.row(row) = point.transpose().array();
        particles.charge[row] = charges == Charges::like    ? charge
                                : charges == Charges::mixed ? (row % 2 == 0 ? charge : -charge)
                                                            : charge * (2 * unit() - 1);
        ++row;
    }
    return particles;
}

DemParticles select(const DemParticles& all, const std::function<bool(Index)>& keep)
{
    std::vector<Index> rows;
    for (Index row = 0; row < all.size(); ++row) {
        if (keep(row)) {
            rows.push_back(row);
        }
    }
    DemParticles some;
    for (const Index row : rows) {
        some.tag.push_back(all.tag[static_cast<std::size_t>(row)]);
        some.type.push_back(all.type[static_cast<std::size_t>(row)]);
    }
    some.position = all.position(rows, Eigen::all);
    some.velocity = all.velocity(rows, Eigen::all);
    some.charge = all.charge(rows);
    some.radius = all.radius(rows);
    some.mass = all.mass(rows);
    return some;
}

DemParticles dealt(const DemParticles& all, MPI_Comm communicator)
{
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &ranks);
    return select(all, [&](Index row) { return all.tag[static_cast<std::size_t>(row)] % ranks == rank; });
}

std::map<int, Vector3> gatherByTag(const std::vector<int>& tags, const Points& values, MPI_Comm communicator)
{
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    std::vector<double> mine;
    for (std::size_t n = 0; n < tags.size(); ++n) {
        const auto row = static_cast<Index>(n);
        mine.insert(mine.end(), {static_cast<double>(tags[n]), values(row, 0), values(row, 1), values(row, 2)});
    }
    const int count = static_cast<int>(mine.size());
    std::vector<int> counts(static_cast<std::size_t>(ranks)), offsets(static_cast<std::size_t>(ranks), 0);
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t r = 1; r < counts.size(); ++r) {
        offsets[r] = offsets[r - 1] + counts[r - 1];
    }
    std::vector<double> all(static_cast<std::size_t>(offsets.back() + counts.back()));
    MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, communicator);
    std::map<int, Vector3> byTag;
    for (std::size_t at = 0; at < all.size(); at += 4) {
        byTag[static_cast<int>(all[at])] = Vector3(all[at + 1], all[at + 2], all[at + 3]);
    }
    return byTag;
}

}  // namespace him
