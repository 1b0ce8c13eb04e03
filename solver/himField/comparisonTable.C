// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/comparisonTable.H"

#include "settings/checkedDictionary.H"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

using row = std::vector<std::string>;

std::string length(double metres, double cellSize)
{
    return shown(metres, 4) + " m" + (cellSize > 0 ? " = " + shown(metres / cellSize, 3) + " h" : "");
}

std::string p3mParameters(const P3mSettings& p3m, double cellSize)
{
    std::string text =
        "R " + (p3m.cloudRadius > 0 ? length(p3m.cloudRadius, cellSize) : shown(p3m.cloudCells) + " cells");
    text += p3m.cloudExponent ? ", k " + std::to_string(p3m.cloudExponent) : "";
    text += p3m.gather == PolynomialOrder::quartic ? ", quartic" : ", cubic";
    text += p3m.deferredCorrection ? " + correction" : "";
    text += p3m.nearPrecision == NearPrecision::singlePrecision ? ", pairs in single" : "";
    return text + (p3m.selfTerm ? " + self term" : "");
}

row headingRow()
{
    return {"method", "parameters", "pairs",      "near",       "deposit", "solve",     "gather",
            "exch.",  "total",      "cold solve", "cold total", "MiB",     "RMS error", "largest"};
}

row textRow(const comparedMethod& m, const comparison& result)
{
    row cells{m.name, parametersOf(m.settings, result.cellSize)};
    if (!m.leftOut.empty()) {
        cells[1] = "left out: " + m.leftOut;
        return cells;
    }
    const auto seconds = [](double value) { return value > 0 ? shown(value, 3) : std::string("-"); };
    cells.push_back(shown(m.neighbours, 4));
    for (const double phase : m.warm.phase) {
        cells.push_back(seconds(phase));
    }
    cells.push_back(seconds(m.warm.total));
    cells.push_back(seconds(m.cold.phase[2]));
    cells.push_back(seconds(m.cold.total));
    cells.push_back(shown(std::round(m.peakMiB), 6));
    cells.push_back(m.judged ? shown(m.rmsError, 3) : "n/a");
    cells.push_back(m.judged ? shown(m.largestError, 3) : "n/a");
    return cells;
}

/// Columns aligned, the first two to the left; a short row (left out) takes no part in the widths.
std::string aligned(const std::vector<row>& rows)
{
    std::vector<std::size_t> width(rows.front().size(), 0);
    for (const row& cells : rows) {
        for (std::size_t n = 0; n < cells.size() && (cells.size() == width.size() || n == 0); ++n) {
            width[n] = std::max(width[n], cells[n].size());
        }
    }
    std::ostringstream text;
    for (const row& cells : rows) {
        for (std::size_t n = 0; n < cells.size(); ++n) {
            text << (n ? "  " : "    ") << (n < 2 ? std::left : std::right)
                 << std::setw(n + 1 == cells.size() && n < 2 ? 0 : static_cast<int>(width[n])) << cells[n];
        }
        text << '\n';
    }
    return text.str();
}

std::string quoted(const std::string& text)
{
    std::string inside = text;
    for (std::size_t at = 0; (at = inside.find('"', at)) != std::string::npos; at += 2) {
        inside.insert(at, 1, '"');
    }
    return '"' + inside + '"';
}

}  // namespace

std::string parametersOf(const FieldSettings& settings, double cellSize)
{
    if (settings.method == "p3m") {
        return p3mParameters(settings.p3m, cellSize);
    }
    std::string text;
    if (FieldMethod::needsCutoff(settings.method)) {
        text = "nearCutoff " + length(settings.nearCutoff, cellSize);
    }
    if (settings.method == "him" && settings.him.ownCellResponse == OwnCellResponse::remove) {
        text += ", own response removed";
    }
    if (settings.method == "himCell") {
        text = settings.himCell.deltaMin > 0 ? "deltaMin " + length(settings.himCell.deltaMin, cellSize)
                                             : "adjacent cells";
    }
    if (settings.method == "pairwiseSum") {
        text = settings.pairwiseSum.images ? "images" : "no images";
        if (std::isfinite(settings.pairwiseSum.truncation)) {
            text += ", up to " + length(settings.pairwiseSum.truncation, cellSize);
        }
    }
    return text;
}

std::string textTable(const comparison& result)
{
    int fewest = 0, most = 0;
    std::vector<row> rows{headingRow()};
    for (const comparedMethod& method : result.methods) {
        rows.push_back(textRow(method, result));
        if (method.rounds > 0) {
            fewest = fewest ? std::min(fewest, method.rounds) : method.rounds;
            most = std::max(most, method.rounds);
        }
    }
    std::ostringstream text;
    text << "Particles   " << result.particles << ", ranks " << result.ranks << '\n'
         << "Mesh        " << (result.mesh.empty() ? "none" : result.mesh);
    if (result.cellSize > 0) {
        text << ", h = " << shown(result.cellSize, 4) << " m (cube root of the mean cell volume)";
    }
    text << '\n' << "Reference   " << (result.reference.empty() ? "none, so no error is known" : result.reference);
    if (!result.reference.empty() && result.judgedParticles < result.particles) {
        text << ", at " << result.judgedParticles << " of the particles";
    }
    text
        << "\nTimes       seconds of one field, medians over "
        << (fewest == most ? std::to_string(most) : std::to_string(fewest) + " to " + std::to_string(most))
        << " rounds in which the methods take turns. Near to total: warm, the solve starts from\n"
           "            the potential before 2 % of the charges moved by 0.35 cells; cold: it starts from zero.\n"
           "Pairs       near pairs per particle. MiB: peak of the program during the method's first field, all ranks.\n"
           "Errors      RMS|E - Eref| and max|E - Eref|, both over RMS|Eref|, the external field left out.\n\n"
        << aligned(rows);
    return text.str();
}

void writeCsvTable(const std::string& file, const comparison& result)
{
    std::ofstream stream(file);
    stream.precision(9);
    stream << "name,fieldMethod,parameters,particles,ranks,pairs_per_particle,rounds,first_s";
    for (const char* start : {"cold", "warm"}) {
        for (const char* phase : {"near", "deposit", "solve", "gather", "exchange", "total"}) {
            stream << ',' << start << '_' << phase << "_s";
        }
    }
    stream
        << ",peak_MiB,growth_MiB,rms_error,largest_error,rms_error_V_per_m,judged_particles,cell_size_m,mesh,reference,"
           "left_out\n";
    for (const comparedMethod& m : result.methods) {
        stream << m.name << ',' << m.settings.method << ',' << quoted(parametersOf(m.settings, result.cellSize)) << ','
               << result.particles << ',' << result.ranks << ',' << m.neighbours << ',' << m.rounds << ','
               << m.firstSeconds;
        for (const callTimes* times : {&m.cold, &m.warm}) {
            for (const double phase : times->phase) {
                stream << ',' << phase;
            }
            stream << ',' << times->total;
        }
        stream << ',' << m.peakMiB << ',' << m.growthMiB;
        if (m.judged) {
            stream << ',' << m.rmsError << ',' << m.largestError << ',' << m.rmsAbsolute << ','
                   << result.judgedParticles;
        } else {
            stream << ",nan,nan,nan,0";
        }
        stream << ',' << result.cellSize << ',' << quoted(result.mesh) << ',' << quoted(result.reference) << ','
               << quoted(m.leftOut) << '\n';
    }
    stream.close();
    if (!stream) {
        throw std::runtime_error("the table " + file + " cannot be written; is the disk full?");
    }
}

}  // namespace him
