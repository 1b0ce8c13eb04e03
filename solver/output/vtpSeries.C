// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/vtpSeries.H"

#include <algorithm>
#include <fstream>
#include <limits>
#include <regex>

namespace him {

void vtpSeries::readEarlier(const Foam::fileName& index)
{
    const std::regex entry("\"name\" : \"([^\"]+)\", \"time\" : ([-+.0-9eE]+)");
    std::ifstream stream(index);
    std::smatch found;
    for (std::string line; std::getline(stream, line);) {
        if (std::regex_search(line, found, entry)) {
            files_.emplace_back(found[1], std::stod(found[2]));
        }
    }
}

void vtpSeries::add(const Foam::fileName& folder, const std::string& name, const std::string& file, double time)
{
    const Foam::fileName index = folder / Foam::word(name + ".vtp.series");
    if (!begun_) {
        readEarlier(index);
        begun_ = true;
    }
    files_.erase(std::remove_if(files_.begin(), files_.end(),
                                [&](const auto& listed) { return listed.second >= time || listed.first == file; }),
                 files_.end());
    files_.emplace_back(file, time);

    std::ofstream stream(index);
    stream.precision(std::numeric_limits<double>::max_digits10);
    stream << "{ \"file-series-version\" : \"1.0\", \"files\" : [\n";
    for (std::size_t n = 0; n < files_.size(); ++n) {
        stream << "{ \"name\" : \"" << files_[n].first << "\", \"time\" : " << files_[n].second << " }"
               << (n + 1 < files_.size() ? ",\n" : "\n");
    }
    stream << "] }\n";
}

}  // namespace him
