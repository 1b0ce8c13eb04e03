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

void FakeDem::setGasForces(const GasForces& forces, double duration)
{
    gas = forces;
    gasGiven.setZero(mine.size(), 3);
    gasTakenOut.setZero();
    gasPromised = (forces.velocity - mine.velocity).colwise() * forces.drag;
    if (forces.force.rows() > 0) {
        gasPromised += forces.force;
    }
    gasPromised *= duration;
}

Vector3 FakeDem::gasImpulse(Points& beyond) const
{
    beyond.setZero(mine.size(), 3);
    if (gas.drag.size() == 0) {
        return Vector3::Zero();
    }
    beyond = gasGiven - gasPromised;
    return gasTakenOut + Vector3(gasGiven.colwise().sum().matrix().transpose());
}

void FakeDem::run(long steps)
{
    if (!handedOver || heldField.rows() != mine.size()) {
        throw std::logic_error("FakeDem::run before hand-over or without a field");
    }
    for (long step = 0; step < steps; ++step) {
        for (Index row = 0; row < mine.size(); ++row) {
            mine.velocity.row(row) += timeStep_ * mine.charge[row] / mine.mass[row] * heldField.row(row);
            if (gas.drag.size() > 0) {
                const double beta = gas.drag[row] / (1 + gas.drag[row] * timeStep_ / mine.mass[row]);
                Eigen::Array<double, 1, 3> counted = beta * (gas.velocity.row(row) - mine.velocity.row(row));
                if (gas.force.rows() > 0) {
                    counted += gas.force.row(row);
                }
                gasGiven.row(row) += timeStep_ * counted;
                mine.velocity.row(row) +=
                    timeStep_ / mine.mass[row] * (counted + gas.volume[row] * gas.buoyancy.transpose().array());
            }
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
