// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/coupled_step.hpp"

#include "dem_coupling/charging/compensated_sum.hpp"
#include "dem_coupling/field_frequency.hpp"
#include "dem_coupling/near_field_refresh.hpp"
#include "dem_coupling/particle_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace him {

CoupledStep::CoupledStep(DemPort& dem, FieldMethod& field, MPI_Comm communicator, PhaseTimes& times)
    : dem_(dem), method_(field), communicator_(communicator), times_(times)
{
}

void CoupledStep::start()
{
    dem_.setPartnerCutoff(method_.partnerCutoff());
    dem_.chargeParticles();
    updateField();
    const PhaseTimer timer(times_, Phase::dem);
    dem_.handOver();
}

void CoupledStep::advance(long demSteps)
{
    {
        const PhaseTimer timer(times_, Phase::dem);
        dem_.run(demSteps);
    }
    updateField();
}

void CoupledStep::updateField()
{
    readParticles();
    bringWallCharges();
    if (booksOpen_ && changeCharges_ && changeCharges_(particles_) && walls_) {
        wallFaceCharge_ = walls_->total();
    }
    method_.compute(particles_, field_);
    summarise();
    if (!booksOpen_) {
        books_.open(summary_.totalCharge, absoluteCharge_, dem_.movements());
        if (walls_ && givenToKeepingWalls() != 0 && !walls_->continued()) {
            throw std::runtime_error(
                "the DEM checkpoint says that contacts have left charge on insulating walls, but the start time "
                "has no wallSurfaceCharge: continue from a time that has both");
        }
        wallFaceOpening_ = walls_ ? wallFaceCharge_ - givenToKeepingWalls() : 0;
        booksOpen_ = true;
    } else {
        books_.post(summary_.totalCharge, absoluteCharge_, dem_.movements());
        stopOnOpenBooks(books_);
        if (walls_ && std::fabs(wallFaceError()) > ChargeBooks::tolerance * books_.scale()) {
            throw std::runtime_error(
                "the charge on the faces of insulating walls is not what contacts left there: off by "
                + std::to_string(wallFaceError() / books_.scale())
                + " of all charge. A wallSurfaceCharge that does not belong to the "
                  "DEM checkpoint makes this: continue from a time that has both");
        }
    }
    {
        const PhaseTimer timer(times_, Phase::dem);
        dem_.setField(particles_, field_.field, field_.ownResponse);
    }
    summary_.heldFrequency = near_ ? near_->heldFrequency(particles_, field_.field) : 0;
}

void CoupledStep::bringWallCharges()
{
    if (walls_) {
        dem_.takeWallCharges(wallCharges_);
        const PhaseTimer timer(times_, Phase::exchange);
        walls_->add(wallCharges_);
        wallFaceCharge_ = walls_->total();
    }
}

double CoupledStep::givenToKeepingWalls() const
{
    CompensatedSum given;
    const std::vector<double>& toWall = books_.movements().toWall;
    for (std::size_t wall = 0; wall < toWall.size(); ++wall) {
        if (walls_->keeps(wall)) {
            given += toWall[wall];
        }
    }
    return given.value();
}

double CoupledStep::wallFaceError() const
{
    return walls_ ? wallFaceCharge_ - wallFaceOpening_ - givenToKeepingWalls() : 0;
}

void CoupledStep::readParticles()
{
    std::int64_t believed = 0;
    {
        const PhaseTimer timer(times_, Phase::dem);
        std::swap(previous_, particles_);
        dem_.particles(particles_);
        believed = dem_.particleCount();
    }
    const std::int64_t mine[2] = {particles_.size(), countBadParticles(particles_)};
    std::int64_t all[2] = {0, 0};
    MPI_Allreduce(mine, all, 2, MPI_INT64_T, MPI_SUM, communicator_);
    summary_.particles = all[0];
    if (all[0] != believed) {
        throwOnLostParticles(particles_, previous_, believed, communicator_);
    }
    if (all[1] > 0) {
        throwOnBadParticles(particles_, previous_, communicator_);
    }
}

void CoupledStep::summarise()
{
    // Numbers that are not finite must not meet a comparison: with floating-point traps on it would end the process
    // without a message. So a bad field is only counted here, and the rest is summed where there is none.
    const std::int64_t bad = countBadFields(field_.field);
    CompensatedSum charge, absolute, kinetic;
    constexpr double lowest = std::numeric_limits<double>::lowest();
    std::array<double, 4> extremes{lowest, lowest, 0, 0};  // -smallest and largest charge, squared field, frequency
    for (Index row = 0; bad == 0 && row < particles_.size(); ++row) {
        const double q = particles_.charge[row];
        charge += q;
        absolute += std::fabs(q);
        kinetic += 0.5 * particles_.mass[row] * particles_.velocity.row(row).square().sum();
        extremes[0] = std::max(extremes[0], -q);
        extremes[1] = std::max(extremes[1], q);
        extremes[2] = std::max(extremes[2], field_.field.row(row).square().sum());
    }
    extremes[3] = bad == 0 ? fieldFrequency(particles_, field_.field) : 0;
    const double energy = method_.hasPotential() && bad == 0 ? field_.energy : 0;
    std::array<double, 5> sums{charge.value(), absolute.value(), energy, kinetic.value(), static_cast<double>(bad)};
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    if (sums[4] > 0) {
        throwOnBadFields(particles_, field_.field, communicator_);
    }
    MPI_Allreduce(MPI_IN_PLACE, extremes.data(), static_cast<int>(extremes.size()), MPI_DOUBLE, MPI_MAX, communicator_);

    const bool any = summary_.particles > 0;
    summary_.totalCharge = sums[0];
    absoluteCharge_ = sums[1];
    summary_.energy = method_.hasPotential() ? sums[2] : std::numeric_limits<double>::quiet_NaN();
    summary_.kineticEnergy = sums[3];
    summary_.smallestCharge = any ? -extremes[0] : 0;
    summary_.largestCharge = any ? extremes[1] : 0;
    summary_.largestField = std::sqrt(extremes[2]);
    summary_.fieldFrequency = extremes[3];
    summary_.excludedCount = field_.excludedCount;
    summary_.excludedCharge = field_.excludedCharge;
}

}  // namespace him
