// SPDX-License-Identifier: GPL-3.0-or-later
// Charges that the host sets, and numbers that it keeps with the particles.
#include "dem_coupling/liggghts/liggghts_dem.hpp"

#include "atom.h"
#include "fix_property_atom.h"
#include "modify.h"

#include <algorithm>
#include <stdexcept>

namespace him {

namespace {

constexpr const char* notesId = "himFoamNotes";

}  // namespace

void LiggghtsDem::stopCharging()
{
    if (charging_) {
        charging_->stopCharging();
    }
}

bool LiggghtsDem::losesCharge() const
{
    return charging_ && charging_->losesCharge();
}

void LiggghtsDem::setCharges(const Scalars& charge)
{
    if (charge.size() != lmp_->atom->nlocal) {
        throw std::logic_error("setCharges: the charges are not those of the particles last read");
    }
    std::copy(charge.begin(), charge.end(), lmp_->atom->q);
}

void LiggghtsDem::giveToWalls(const std::vector<double>& charge)
{
    int rank = 0;
    MPI_Comm_rank(communicator_, &rank);
    if (!charging_ || charge.size() != walls_.size()) {
        throw std::logic_error("giveToWalls: one charge per wall of a scene with charging");
    }
    for (std::size_t wall = 0; rank == 0 && wall < charge.size(); ++wall) {
        charging_->transfer().toWall()[wall] += charge[wall];
    }
}

void LiggghtsDem::keepNotes(int columns)
{
    std::string line = std::string("fix ") + notesId + " all property/atom " + notesId + " vector yes no no";
    for (int column = 0; column < columns; ++column) {
        line += " 0.";
    }
    command(line);
    notes_ = static_cast<LAMMPS_NS::FixPropertyAtom*>(lmp_->modify->find_fix_id(notesId));
    noteColumns_ = columns;
}

void LiggghtsDem::notes(Notes& out) const
{
    const int rows = notes_ ? lmp_->atom->nlocal : 0;
    out.resize(rows, noteColumns_);
    for (int i = 0; i < rows; ++i) {
        for (int column = 0; column < noteColumns_; ++column) {
            out(i, column) = notes_->array_atom[i][column];
        }
    }
}

void LiggghtsDem::setNotes(const Notes& notes)
{
    if (!notes_ || notes.rows() != lmp_->atom->nlocal || notes.cols() != noteColumns_) {
        throw std::logic_error("setNotes: the notes are not those of the particles last read");
    }
    for (int i = 0; i < lmp_->atom->nlocal; ++i) {
        for (int column = 0; column < noteColumns_; ++column) {
            notes_->array_atom[i][column] = notes(i, column);
        }
    }
}

}  // namespace him
