// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/particleTable.H"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace him {

namespace {

constexpr std::array<const char*, 4> outputColumns{"Ex", "Ey", "Ez", "V"};

/// Where in a line the columns stand that are read.
struct columns {
    std::array<std::size_t, 4> xyzq{};
    std::size_t radius = 0;
    bool hasRadius = false;
    std::size_t count = 0;
};

std::string_view trimmed(std::string_view text)
{
    constexpr const char* blank = " \t\r";
    const std::size_t begin = text.find_first_not_of(blank);
    return begin == std::string_view::npos ? std::string_view{}
                                           : text.substr(begin, text.find_last_not_of(blank) + 1 - begin);
}

std::vector<std::string_view> split(std::string_view line)
{
    std::vector<std::string_view> values;
    for (std::size_t begin = 0;;) {
        const std::size_t comma = line.find(',', begin);
        values.push_back(trimmed(line.substr(begin, comma - begin)));
        if (comma == std::string_view::npos) {
            return values;
        }
        begin = comma + 1;
    }
}

/// False when the text is not one number.
bool parse(std::string_view text, double& value)
{
    if (!text.empty() && text.front() == '+') {
        text.remove_prefix(1);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// Complains about columns that are missing or there twice.
columns readHeader(const std::string& header, const std::string& where, Complaints& complaints)
{
    const std::vector<std::string_view> names = split(header);
    columns found;
    found.count = names.size();
    const auto place = [&](const char* name, bool required) {
        const auto first = std::find(names.begin(), names.end(), name);
        if (required && first == names.end()) {
            complaints.add(where, std::string("there is no column `") + name + "`. Found the header `" + header
                                      + "`; needed are x,y,z,q in m and C, in any order.");
        }
        if (first != names.end() && std::find(first + 1, names.end(), name) != names.end()) {
            complaints.add(where, std::string("the column `") + name + "` is there twice.");
        }
        return static_cast<std::size_t>(first - names.begin());
    };
    found.xyzq = {place("x", true), place("y", true), place("z", true), place("q", true)};
    found.radius = place("radius", false);
    found.hasRadius = found.radius < names.size();
    for (const char* name : outputColumns) {
        if (std::find(names.begin(), names.end(), name) != names.end()) {
            complaints.add(where,
                           std::string("the column `") + name + "` is one that the output gets. Rename or remove it.");
        }
    }
    return found;
}

/// One finite number, or a complaint and nothing.
std::optional<double> number(std::string_view text, const char* column, const std::string& place,
                             rowComplaints& complaints)
{
    double value = 0;
    const bool read = parse(text, value);
    if (read && std::isfinite(value)) {
        return value;
    }
    complaints.add(place, std::string(column) + ": found `" + std::string(text) + "`, but a " + (read ? "finite " : "")
                              + "number is expected.");
    return {};
}

void refuseCoincidence(const particleTable& table, rowComplaints& complaints)
{
    std::vector<Index> order;
    for (Index row = 0; row < table.size(); ++row) {
        if (!table.faulty[static_cast<std::size_t>(row)]) {
            order.push_back(row);
        }
    }
    const auto key = [&](Index row) {
        return std::array<double, 3>{table.position(row, 0), table.position(row, 1), table.position(row, 2)};
    };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (std::size_t n = 1; n < order.size(); ++n) {
        if (key(order[n - 1]) == key(order[n])) {
            complaints.add(table.place(order[n]), "the particle is at the same position as that of "
                                                      + table.place(order[n - 1])
                                                      + ", so their field is infinite. Remove one of them.");
        }
    }
}

/// x, y, z, q, radius of a line; zeros and 1 in place of what is wrong.
std::array<double, 5> readRow(const std::string& line, const columns& found, const std::string& place,
                              rowComplaints& faults)
{
    const std::vector<std::string_view> texts = split(line);
    std::array<double, 5> row{0, 0, 0, 0, 1};
    if (texts.size() != found.count) {
        faults.add(place, "found " + std::to_string(texts.size()) + " values, but the header has "
                              + std::to_string(found.count) + " columns.");
        return row;
    }
    constexpr std::array<const char*, 4> names{"x", "y", "z", "q"};
    for (std::size_t n = 0; n < names.size(); ++n) {
        row[n] = number(texts[found.xyzq[n]], names[n], place, faults).value_or(0);
    }
    if (found.hasRadius) {
        row[4] = number(texts[found.radius], "radius", place, faults).value_or(1);
        if (!(row[4] > 0)) {
            faults.add(place, "radius: found `" + std::string(texts[found.radius])
                                  + "`, but a number above zero is expected.");
        }
    }
    return row;
}

void fillArrays(const std::vector<std::array<double, 5>>& values, bool hasRadius, particleTable& table)
{
    table.position.resize(table.size(), 3);
    table.charge.resize(table.size());
    table.radius.resize(hasRadius ? table.size() : 0);
    for (Index row = 0; row < table.size(); ++row) {
        const std::array<double, 5>& v = values[static_cast<std::size_t>(row)];
        table.position.row(row) << v[0], v[1], v[2];
        table.charge[row] = v[3];
        if (hasRadius) {
            table.radius[row] = v[4];
        }
    }
}

std::string placeOf(long line, Index row)
{
    return "line " + std::to_string(line) + " (particle " + std::to_string(row + 1) + ")";
}

}  // namespace

std::string particleTable::place(Index row) const
{
    return placeOf(lineNumber[static_cast<std::size_t>(row)], row);
}

void rowComplaints::add(const std::string& place, const std::string& what)
{
    if (++count_ <= kept) {
        complaints_.add(file_ + ": " + place, what);
    }
}

void rowComplaints::close()
{
    if (count_ > kept) {
        complaints_.add(file_, "and " + std::to_string(count_ - kept) + " more faulty lines.");
    }
}

particleTable readParticleTable(const std::string& file, Complaints& complaints, rowComplaints& faults)
{
    particleTable table;
    std::ifstream stream(file);
    if (!stream) {
        complaints.add(file, "the file of the particles cannot be opened.");
        return table;
    }
    columns found;
    std::vector<std::array<double, 5>> values;
    std::string line;
    for (long lineNumber = 1; std::getline(stream, line); ++lineNumber) {
        if (lineNumber == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) {
            line.erase(0, 3);  // byte-order mark of spreadsheet programs
        }
        line = std::string(trimmed(line));
        if (line.empty() || line.front() == '#') {
            continue;
        }
        if (table.header.empty()) {
            table.header = line;
            const std::size_t before = complaints.lines().size();
            found = readHeader(line, file + ": line " + std::to_string(lineNumber), complaints);
            if (complaints.lines().size() > before) {
                return table;
            }
            continue;
        }
        const long faultsBefore = faults.count();
        values.push_back(readRow(line, found, placeOf(lineNumber, table.size()), faults));
        table.lines.push_back(line);
        table.lineNumber.push_back(lineNumber);
        table.faulty.push_back(faults.count() > faultsBefore);
    }
    if (table.header.empty()) {
        complaints.add(file, "the file is empty. Its first line must name the columns x,y,z,q.");
    } else if (values.empty()) {
        complaints.add(file, "there is no particle below the header.");
    }
    fillArrays(values, found.hasRadius, table);
    refuseCoincidence(table, faults);
    return table;
}

void writeParticleTable(const std::string& file, const particleTable& table, const Points& field,
                        const Scalars& potential)
{
    std::FILE* stream = std::fopen(file.c_str(), "w");
    if (!stream) {
        throw std::runtime_error("the file " + file + " cannot be written. Give another one with -output.");
    }
    std::fprintf(stream, "%s,Ex,Ey,Ez,V\n", table.header.c_str());
    for (Index row = 0; row < table.size(); ++row) {
        std::fprintf(stream, "%s,%.17g,%.17g,%.17g,", table.lines[static_cast<std::size_t>(row)].c_str(), field(row, 0),
                     field(row, 1), field(row, 2));
        if (potential.size() > 0) {
            std::fprintf(stream, "%.17g\n", potential[row]);
        } else {
            std::fputs("nan\n", stream);
        }
    }
    const bool failed = std::ferror(stream) != 0;
    if (std::fclose(stream) != 0 || failed) {
        throw std::runtime_error("writing " + file + " failed; is the disk full?");
    }
}

}  // namespace him
