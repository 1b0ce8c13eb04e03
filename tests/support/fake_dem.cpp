// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/fake_dem.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace him {

FakeDem::FakeDem(DemParticles particles, const Box& box, const std::array<bool, 3>& periodic, double timeStep,
                 MPI_Comm communicator)
    : mine(std::move(particles)), box_(box), periodic_(periodic), timeStep_(timeStep)
{
    believedCount = mine.size();
    MPI_Allreduce(MPI_IN_PLACE, &believedCount, 1, MPI_INT64_T, MPI_SUM, communicator);
}

void FakeDem::setField(const DemParticles& particles, const Points& field, const Points&)
{
    if (particles.tag != mine.tag || field.rows() != mine.size()) {
        throw std::logic_error("FakeDem::setField: not the particles that were given out");
    }
    heldField = field;
    ++fieldsSet;
}

void FakeDem::run(long steps)
{
    if (!handedOver || heldField.rows() != mine.size()) {
        throw std::logic_error("FakeDem::run before hand-over or without a field");
    }
    for (long step = 0; step < steps; ++step) {
        for (Index row = 0; row < mine.size(); ++row) {
            mine.velocity.row(row) += timeStep_ * mine.charge[row] / mine.mass[row] * heldField.row(row);
            mine.position.row(row) += timeStep_ * mine.velocity.row(row);
            for (int axis = 0; axis < 3; ++axis) {
                if (periodic_[static_cast<std::size_t>(axis)]) {
                    double& x = mine.position(row, axis);
                    x -= box_.size()[axis] * std::floor((x - box_.lower[axis]) / box_.size()[axis]);
                }
            }
        }
    }
    if (duringRun) {
        duringRun();
    }
}

}  // namespace him
