// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/conversions.H"
#include "output/particleWriter.H"

#include "IOField.H"
#include "passiveParticleCloud.H"

namespace him {

namespace {

template <class Value, class Read>
void writeField(const Foam::passiveParticleCloud& cloud, const std::vector<particleRecord>& records, const char* name,
                Read&& read)
{
    Foam::IOField<Value> values(cloud.fieldIOobject(name, Foam::IOobject::NO_READ),
                                static_cast<Foam::label>(records.size()));
    forAll(values, i)
    {
        values[i] = read(records[static_cast<std::size_t>(i)]);
    }
    values.write(!records.empty());
}

Foam::vector toFoam(const std::array<double, 3>& v)
{
    return {v[0], v[1], v[2]};
}

}  // namespace

particleCloudWriter::particleCloudWriter(const Foam::fvMesh& mesh, const CellMesh& cells, const Box& demBox,
                                         const std::array<bool, 3>& periodic, MPI_Comm communicator)
    : mesh_(mesh), locator_(cells, communicator, demBox, periodic), exchange_(communicator)
{
}

void particleCloudWriter::write(const DemParticles& particles, const Points& field)
{
    // Rank and cell of every particle; (0 0 0) for those outside the mesh.
    locator_.locate(particles.position);
    Points places;
    const double rank = exchange_.rank();
    locator_.gather([rank](Index cell) { return Vector3(rank, static_cast<double>(cell), 1); }, places);
    std::vector<int> targetRanks;
    std::vector<long> cells;
    for (Index i = 0; i < particles.size(); ++i) {
        targetRanks.push_back(places(i, 2) == 1 ? static_cast<int>(places(i, 0)) : -1);
        cells.push_back(static_cast<long>(places(i, 1)));
    }
    std::vector<particleRecord> records = collectRecords(particles, field, targetRanks, cells, exchange_);
    for (particleRecord& record : records) {
        const Vector3 shift = locator_.shiftIntoBox(Vector3(record.position.data()));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            record.position[axis] += shift[static_cast<Index>(axis)];
        }
    }

    Foam::passiveParticleCloud cloud(mesh_, "particles", Foam::IDLList<Foam::passiveParticle>());
    for (const particleRecord& record : records) {
        auto particle = std::make_unique<Foam::passiveParticle>(mesh_, toFoam(record.position),
                                                                static_cast<Foam::label>(record.cell));
        particle->origId() = static_cast<Foam::label>(record.tag);
        cloud.addParticle(particle.release());
    }
    cloud.write(!records.empty());
    writeField<Foam::vector>(cloud, records, "U", [](const particleRecord& r) { return toFoam(r.velocity); });
    writeField<Foam::vector>(cloud, records, "electricField", [](const particleRecord& r) { return toFoam(r.field); });
    writeField<Foam::scalar>(cloud, records, "charge", [](const particleRecord& r) { return r.charge; });
    writeField<Foam::scalar>(cloud, records, "radius", [](const particleRecord& r) { return r.radius; });
    writeField<Foam::label>(cloud, records, "type", [](const particleRecord& r) { return Foam::label(r.type); });
    writeField<Foam::label>(cloud, records, "tag", [](const particleRecord& r) { return Foam::label(r.tag); });
}

}  // namespace him
