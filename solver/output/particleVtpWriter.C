// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/particleWriter.H"

#include "OSspecific.H"

#include <fstream>

namespace him {

namespace {

std::ostream& operator<<(std::ostream& stream, const std::array<double, 3>& v)
{
    return stream << v[0] << ' ' << v[1] << ' ' << v[2];
}

template <class Read>
void writeArray(std::ostream& stream, const std::vector<particleRecord>& records, const std::string& type,
                const std::string& name, int components, Read&& read)
{
    stream << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
           << "\" format=\"ascii\">\n";
    for (const particleRecord& record : records) {
        stream << read(record) << '\n';
    }
    stream << "</DataArray>\n";
}

}  // namespace

particleVtpWriter::particleVtpWriter(const Foam::Time& runTime, MPI_Comm communicator)
    : runTime_(runTime), exchange_(communicator), folder_(runTime.globalPath() / "postProcessing" / "particles")
{
    if (exchange_.rank() == 0) {
        Foam::mkDir(folder_);
    }
}

void particleVtpWriter::write(const DemParticles& particles, const Points& field)
{
    const auto rows = static_cast<std::size_t>(particles.size());
    const std::vector<particleRecord> records =
        collectRecords(particles, field, std::vector<int>(rows, 0), std::vector<long>(rows, -1), exchange_);
    if (exchange_.rank() == 0) {
        const Foam::fileName file = runTime_.timeName() + ".vtp";
        writeFile(records, folder_ / file);
        series_.add(folder_, "particles", file, runTime_.value());
    }
}

void particleVtpWriter::writeFile(const std::vector<particleRecord>& records, const Foam::fileName& file) const
{
    std::ofstream stream(file);
    stream.precision(12);
    stream << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
              "byte_order=\"LittleEndian\">\n<PolyData>\n"
           << "<Piece NumberOfPoints=\"" << records.size() << "\" NumberOfVerts=\"" << records.size()
           << "\">\n<Points>\n";
    writeArray(stream, records, "Float64", "position", 3, [](const particleRecord& r) { return r.position; });
    stream << "</Points>\n<PointData Scalars=\"charge\" Vectors=\"U\">\n";
    writeArray(stream, records, "Float64", "charge", 1, [](const particleRecord& r) { return r.charge; });
    writeArray(stream, records, "Float64", "radius", 1, [](const particleRecord& r) { return r.radius; });
    writeArray(stream, records, "Float64", "U", 3, [](const particleRecord& r) { return r.velocity; });
    writeArray(stream, records, "Float64", "electricField", 3, [](const particleRecord& r) { return r.field; });
    writeArray(stream, records, "Int32", "type", 1, [](const particleRecord& r) { return static_cast<int>(r.type); });
    writeArray(stream, records, "Int32", "tag", 1, [](const particleRecord& r) { return static_cast<int>(r.tag); });
    stream << "</PointData>\n<Verts>\n";
    const auto number = [&records](const particleRecord& r) { return &r - records.data(); };
    writeArray(stream, records, "Int64", "connectivity", 1, number);
    writeArray(stream, records, "Int64", "offsets", 1, [&](const particleRecord& r) { return number(r) + 1; });
    stream << "</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace him
