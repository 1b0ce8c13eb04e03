// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/particleWriter.H"

#include <algorithm>
#include <cstring>

namespace him {

namespace {

constexpr std::size_t doublesPerRecord = sizeof(particleRecord) / sizeof(double);
static_assert(sizeof(particleRecord) == 14 * sizeof(double), "a record travels as doubles");

std::array<double, 3> row(const Points& points, Index index)
{
    return {points(index, 0), points(index, 1), points(index, 2)};
}

}  // namespace

std::vector<particleRecord> collectRecords(const DemParticles& particles, const Points& field,
                                           const std::vector<int>& targetRanks, const std::vector<long>& cells,
                                           SparseExchange& exchange)
{
    SparseExchange::Buffers outgoing, incoming;
    exchange.clear(outgoing);
    for (Index i = 0; i < particles.size(); ++i) {
        const auto n = static_cast<std::size_t>(i);
        if (targetRanks[n] < 0) {
            continue;
        }
        const particleRecord record{static_cast<double>(particles.tag[n]),
                                    static_cast<double>(particles.type[n]),
                                    static_cast<double>(cells[n]),
                                    particles.charge[i],
                                    particles.radius[i],
                                    row(particles.position, i),
                                    row(particles.velocity, i),
                                    row(field, i)};
        const auto* begin = reinterpret_cast<const double*>(&record);
        std::vector<double>& buffer = outgoing[static_cast<std::size_t>(targetRanks[n])];
        buffer.insert(buffer.end(), begin, begin + doublesPerRecord);
    }
    exchange.exchange(outgoing, incoming);

    std::vector<particleRecord> records;
    for (const std::vector<double>& buffer : incoming) {
        for (std::size_t at = 0; at < buffer.size(); at += doublesPerRecord) {
            std::memcpy(&records.emplace_back(), buffer.data() + at, sizeof(particleRecord));
        }
    }
    std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) { return a.tag < b.tag; });
    return records;
}

std::unique_ptr<particleWriter> particleWriter::create(const Foam::Time& runTime, const Foam::fvMesh* mesh,
                                                       const CellMesh* cells, const Box& demBox,
                                                       const std::array<bool, 3>& periodic, MPI_Comm communicator)
{
    if (mesh) {
        return std::make_unique<particleCloudWriter>(*mesh, *cells, demBox, periodic, communicator);
    }
    return std::make_unique<particleVtpWriter>(runTime, communicator);
}

}  // namespace him
