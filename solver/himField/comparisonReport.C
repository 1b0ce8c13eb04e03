// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/comparisonReport.H"

#include "himField/comparisonTable.H"

#include "OSspecific.H"
#include "lduMatrix.H"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <unistd.h>

namespace him {

namespace {

/// The script beside this program.
std::string plotScript()
{
    std::array<char, 4096> path{};
    const ssize_t size = readlink("/proc/self/exe", path.data(), path.size() - 1);
    return Foam::fileName(std::string(path.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)))).path()
           / "plotComparison.py";
}

/// Draws the table; says how to do it by hand when that fails. Debian's own Python has matplotlib; another one may come
/// first on PATH.
void draw(const Foam::fileName& csv)
{
    const std::string arguments = " '" + plotScript() + "' '" + csv + "'";
    for (const char* python : {"/usr/bin/python3", "python3"}) {
        if (std::system((python + arguments + " > /dev/null 2>&1").c_str()) == 0) {
            Foam::Info << "    drawn in " << csv.lessExt() << ".png and .svg" << Foam::endl;
            return;
        }
    }
    Foam::Info << "    not drawn: there is no python3 with matplotlib. Later: python3" << arguments.c_str()
               << Foam::endl;
}

}  // namespace

void reportComparison(snapshot& s, const particleTable& table, const particleShares& shares,
                      const comparisonOptions& options, const Foam::fileName& folder, MPI_Comm communicator)
{
    Foam::Info << "\nComparison of field methods" << Foam::endl;
    Foam::solverPerformance::debug = 0;  // no line for every solve
    const comparison result = compareMethods(s, table, shares, options, communicator);
    if (Foam::Pstream::master()) {
        const std::string text = textTable(result);
        Foam::mkDir(folder);
        writeCsvTable(folder / "compare.csv", result);
        std::ofstream(folder / "compare.txt") << text;
        Foam::Info << '\n' << text.c_str() << "\n    written to " << folder << "/compare.csv and .txt" << Foam::endl;
        draw(folder / "compare.csv");
    }
    Foam::Info << "\nEnd\n" << Foam::endl;
}

}  // namespace him
