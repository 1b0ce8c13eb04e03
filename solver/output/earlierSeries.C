// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/statisticsTables.H"

#include "OSspecific.H"

#include <algorithm>
#include <limits>
#include <sstream>

namespace him {

std::vector<earlierSample> readEarlierSeries(const Foam::fileName& folder, const std::string& region, double startTime)
{
    std::vector<std::pair<double, Foam::fileName>> runs;
    for (const Foam::fileName& name : Foam::readDir(folder, Foam::fileName::DIRECTORY)) {
        std::istringstream text(name);
        double start = 0;
        if (text >> start && text.eof() && start < startTime
            && Foam::isFile(folder / name / (region + ".dat"), false)) {
            runs.emplace_back(start, folder / name / (region + ".dat"));
        }
    }
    std::sort(runs.begin(), runs.end());

    std::vector<earlierSample> samples;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const double end = run + 1 < runs.size() ? runs[run + 1].first : startTime;
        std::ifstream file(runs[run].second);
        std::size_t timeColumn = 0, valueColumn = 0, countColumn = 0;
        for (std::string line; std::getline(file, line);) {
            std::istringstream words(line);
            if (line.rfind("# Time", 0) == 0) {
                std::string name;
                words >> name;
                for (std::size_t column = 0; words >> name; ++column) {
                    timeColumn = name == "chargingTime" ? column : timeColumn;
                    valueColumn = name == "chargePerMass" ? column : valueColumn;
                    countColumn = name == "particles" ? column : countColumn;
                }
                continue;
            }
            std::vector<double> numbers;
            for (double number = 0; words >> number;) {
                numbers.push_back(number);
            }
            // The line of a run's start stands in the run before it, too.
            if (numbers.size() > std::max(timeColumn, valueColumn) && valueColumn > 0 && numbers[0] < end * (1 - 1e-9)
                && numbers[countColumn] > 0) {
                samples.push_back({numbers[timeColumn], numbers[valueColumn]});
            }
        }
    }
    return samples;
}

}  // namespace him
