// SPDX-License-Identifier: GPL-3.0-or-later
// How fix charge/gran/contact grows, migrates and restarts with the particles.
#include "dem_coupling/liggghts/fix_charge_gran_contact.hpp"

#include "atom.h"
#include "comm.h"

#include <cstdio>
#include <vector>

namespace him {
namespace {

/// Wall contacts of one particle that a restart file makes room for.
constexpr int restartContacts = 64;

}  // namespace

void FixChargeGranContact::grow_arrays(int rows)
{
    wallMemory_.resize(rows);
    booked_.resize(rows, 0);
    charged_.resize(rows, 0);
}

void FixChargeGranContact::copy_arrays(int from, int to, int)
{
    wallMemory_.copyRow(from, to);
    booked_[to] = booked_[from];
    charged_[to] = charged_[from];
}

void FixChargeGranContact::set_arrays(int row)
{
    wallMemory_.clearRow(row);
    booked_[row] = 0;
    charged_[row] = 0;
    arrivals_ = true;
}

std::size_t FixChargeGranContact::packRow(int row, double* buffer) const
{
    buffer[0] = booked_[row];
    buffer[1] = charged_[row];
    return 2 + wallMemory_.pack(row, buffer + 2);
}

int FixChargeGranContact::pack_exchange(int row, double* buffer)
{
    return static_cast<int>(packRow(row, buffer));
}

int FixChargeGranContact::unpack_exchange(int row, double* buffer)
{
    booked_[row] = static_cast<char>(buffer[0]);
    charged_[row] = static_cast<char>(buffer[1]);
    arrivals_ = arrivals_ || !booked_[row];
    return static_cast<int>(2 + wallMemory_.unpack(row, buffer + 2));
}

int FixChargeGranContact::size_restart(int row)
{
    return static_cast<int>(3 + wallMemory_.packedSize(row));
}

int FixChargeGranContact::maxsize_restart()
{
    return 3 + 1 + static_cast<int>(WallContactMemory::contactDoubles) * restartContacts;
}

int FixChargeGranContact::pack_restart(int row, double* buffer)
{
    const std::size_t n = packRow(row, buffer + 1);
    buffer[0] = static_cast<double>(n + 1);
    return static_cast<int>(n + 1);
}

void FixChargeGranContact::unpack_restart(int row, int nth)
{
    // The extra values of all fixes stand one after the other, each with its length in front.
    const double* extra = atom->extra[row];
    int at = 0;
    for (int fix = 0; fix < nth; ++fix) {
        at += static_cast<int>(extra[at]);
    }
    booked_[row] = static_cast<char>(extra[at + 1]);
    charged_[row] = static_cast<char>(extra[at + 2]);
    wallMemory_.unpack(row, extra + at + 3);
}

void FixChargeGranContact::write_restart(FILE* file)
{
    const ChargeMovements total = movements();
    const ContactCounts counts = contacts();
    if (comm->me != 0) {
        return;
    }
    std::vector<double> state{total.inserted,    total.leaked,        total.breakdown,
                              counts.breakdowns, counts.strongFrozen, static_cast<double>(total.toWall.size())};
    for (std::size_t row = 0; row < total.toWall.size(); ++row) {
        state.push_back(markOf(walls_[row].wall.name));
        state.push_back(total.toWall[row]);
    }
    const int bytes = static_cast<int>(state.size() * sizeof(double));
    fwrite(&bytes, sizeof(int), 1, file);
    fwrite(state.data(), sizeof(double), state.size(), file);
}

void FixChargeGranContact::restart(char* buffer)
{
    // The sums over all ranks continue on rank 0.
    if (comm->me != 0) {
        return;
    }
    const auto* state = reinterpret_cast<const double*>(buffer);
    inserted_ = CompensatedSum(state[0]);
    losses_.leaked() = CompensatedSum(state[1]);
    losses_.brokenDown() = CompensatedSum(state[2]);
    losses_.breakdowns() = state[3];
    transfer_.strongFrozenContacts() = state[4];
    restartedToWall_.clear();
    for (std::size_t row = 0; row < static_cast<std::size_t>(state[5]); ++row) {
        restartedToWall_[state[6 + 2 * row]] = state[7 + 2 * row];
    }
    refreshWalls();
}

}  // namespace him
