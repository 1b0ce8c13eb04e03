// SPDX-License-Identifier: GPL-3.0-or-later
// liggghtsHim: plain LIGGGHTS with himFoam's styles, for scenes without OpenFOAM. Takes LIGGGHTS' own command line.
#include "dem_coupling/liggghts/contact_models.hpp"
#include "dem_coupling/liggghts/cut_domain.hpp"
#include "dem_coupling/liggghts/fix_registry.hpp"

#include "input.h"
#include "lammps.h"

#include <cstdio>
#include <mpi.h>

int main(int argc, char** argv)
{
    // LIGGGHTS ends the process without a flush when a script is wrong.
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    MPI_Init(&argc, &argv);
    {
        him::registerContactModels();
        LAMMPS_NS::LAMMPS liggghts(argc, argv, MPI_COMM_WORLD);
        him::registerFixes(&liggghts);
        him::registerCutDomain(&liggghts);
        liggghts.input->file();
    }
    MPI_Finalize();
    return 0;
}
