// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/cut_domain.hpp"

#include "dem_coupling/liggghts/private_access.hpp"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "input.h"
#include "lammps.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace him {

using CommandCreator = void (*)(LAMMPS_NS::LAMMPS*, int, char**);

struct CommandMap {
    using Member = std::map<std::string, CommandCreator>* LAMMPS_NS::Input::*;
    friend Member memberOf(CommandMap);
};
template struct PrivateMember<CommandMap, &LAMMPS_NS::Input::command_map>;

namespace {

constexpr const char* name = "cut_domain";

/// LIGGGHTS' communication with parts of the box of unequal size. LIGGGHTS lays out the parts anew whenever it makes or reads
/// a box, so the cuts are made there.
class CutComm : public LAMMPS_NS::Comm {
public:
    using LAMMPS_NS::Comm::Comm;

    std::array<std::vector<double>, 3> cuts;  ///< [m], ascending

    void set_proc_grid(int outflag) override
    {
        LAMMPS_NS::Comm::set_proc_grid(outflag);
        const std::array<double*, 3> split{xsplit, ysplit, zsplit};
        for (std::size_t axis = 0; axis < 3 && nprocs > 1; ++axis) {
            if (cuts[axis].empty()) {
                continue;
            }
            const double lower = domain->boxlo[axis], upper = domain->boxhi[axis];
            if (procgrid[axis] != static_cast<int>(cuts[axis].size()) + 1) {
                stop(axis, std::to_string(cuts[axis].size() + 1) + " parts, but the grid of ranks has "
                               + std::to_string(procgrid[axis]) + " along this axis. Give `processors` that many");
            }
            for (std::size_t n = 0; n < cuts[axis].size(); ++n) {
                const double place = cuts[axis][n];
                if (!(place > (n == 0 ? lower : cuts[axis][n - 1])) || !(place < upper)) {
                    std::ostringstream text;
                    text << "a cut at " << place << " m, but cuts must ascend between " << lower << " and " << upper
                         << " m, the ends of the box";
                    stop(axis, text.str());
                }
                split[axis][n + 1] = (place - lower) / (upper - lower);
            }
            uniform = 0;
        }
    }

private:
    void stop(std::size_t axis, const std::string& found)
    {
        error->all(FLERR, (std::string(name) + " " + "xyz"[axis] + " makes " + found).c_str());
    }
};

/// A number of the script [m], or an error.
double placeFrom(LAMMPS_NS::LAMMPS* lmp, const char* word)
{
    char* end = nullptr;
    const double place = std::strtod(word, &end);
    if (end == word || *end != '\0' || !std::isfinite(place)) {
        lmp->error->all(FLERR, (std::string(name) + ": a place must be a number [m], found '" + word + "'").c_str());
    }
    return place;
}

void cutDomain(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg)
{
    const std::string axis = narg > 0 ? arg[0] : "";
    const std::size_t number = std::string("xyz").find(axis);
    if (axis.size() != 1 || number == std::string::npos || narg < 2) {
        lmp->error->all(FLERR, "cut_domain: expected an axis, x, y or z, and one or more places [m] after it");
    }
    auto* comm = dynamic_cast<CutComm*>(lmp->comm);
    if (!comm) {
        const LAMMPS_NS::Comm& old = *lmp->comm;
        if (lmp->domain->box_exist || old.user_procgrid[0] || old.user_procgrid[1] || old.user_procgrid[2]
            || old.ghost_velocity || old.cutghostuser > 0) {
            lmp->error->all(FLERR, "cut_domain must stand before `processors`, `communicate` and the box (create_box, "
                                   "read_restart, read_data)");
        }
        delete lmp->comm;
        comm = new CutComm(lmp);
        lmp->comm = comm;
    }
    comm->cuts[number].clear();
    for (int n = 1; n < narg; ++n) {
        comm->cuts[number].push_back(placeFrom(lmp, arg[n]));
    }
}

}  // namespace

void registerCutDomain(LAMMPS_NS::LAMMPS* lmp)
{
    auto& commands = *(lmp->input->*memberOf(CommandMap{}));
    if (!commands.emplace(name, &cutDomain).second) {
        throw std::runtime_error("LIGGGHTS already has a command 'cut_domain'");
    }
}

}  // namespace him
