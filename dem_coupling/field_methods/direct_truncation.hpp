// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/particle_halo.hpp"
#include "dem_coupling/field_method.hpp"
#include "electrostatics/near_field.hpp"

namespace him {

/// `directTruncation` (DT): R29 over the pairs within nearCutoff, periodic copies included. Charges farther apart and
/// walls do not act.
class DirectTruncation : public FieldMethod {
public:
    DirectTruncation(const FieldSettings& settings, const Box& demBox, const std::array<bool, 3>& periodic,
                     MPI_Comm communicator, PhaseTimes& times);

    void compute(const DemParticles& particles, ParticleField& result) override;
    double partnerCutoff() const override { return settings_.nearCutoff; }
    bool hasPotential() const override { return true; }

private:
    FieldSettings settings_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    ParticleHalo halo_;
    NearField near_;
    ChargedPoints points_;
    PairSumResult sums_;
};

}  // namespace him
