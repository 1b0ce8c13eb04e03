// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/direct_truncation.hpp"

#include "dem_coupling/field_methods/shared_steps.hpp"

#include <stdexcept>

namespace him {

DirectTruncation::DirectTruncation(const FieldSettings& settings, const Box& demBox, const std::array<bool, 3>& periodic,
                                   MPI_Comm communicator, PhaseTimes& times)
    : settings_(settings),
      communicator_(communicator),
      times_(times),
      halo_(settings.nearCutoff, demBox, periodic, communicator),
      near_(settings.nearCutoff, settings.permittivity)
{
}

void DirectTruncation::compute(const DemParticles& particles, ParticleField& result)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        points_.position = particles.position;
        points_.charge = particles.charge;
        points_.cellCentre = particles.position;
        halo_.extend(points_);
    }
    std::string failure;
    sums_.pairs = 0;
    try {
        const PhaseTimer timer(times_, Phase::near);
        near_.coulomb(points_, sums_);
    } catch (const std::domain_error& error) {
        failure = error.what();
    }
    result.pairs = sumPairs(sums_.pairs, failure, particles, points_.position, communicator_);
    result.field = sums_.field;
    result.potential = sums_.potential;
    addExternalField(settings_.externalField, result);
    addExternalPotential(settings_.externalField, particles, result);
}

}  // namespace him
