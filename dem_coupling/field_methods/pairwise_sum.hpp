// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/field_method.hpp"
#include "dem_coupling/field_methods/wall_images.hpp"

namespace him {

/// `pairwiseSum` (PS): R29 over all pairs of all ranks, without cutoff, walls or periodic copies. Every rank's particles
/// travel once around the ring of ranks; no rank ever holds more than two ranks' particles besides its own.
class PairwiseSum : public FieldMethod, public PointField {
public:
    PairwiseSum(const FieldSettings& settings, MPI_Comm communicator, PhaseTimes& times);

    void compute(const DemParticles& particles, ParticleField& result) override;
    double partnerCutoff() const override;
    bool hasPotential() const override { return true; }
    PointField* pointField() override { return this; }
    void fieldOfOthers(const DemParticles& sources, const Points& points, const std::vector<int>& leftOut,
                       Points& field) override;

private:
    /// Sends the visiting particles on to the next rank and receives the previous rank's.
    void passOn();

    FieldSettings settings_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    WallImages walls_;
    WallImages::Set images_;
    Points visitors_, nextVisitors_;
    Scalars visitorCharge_, nextVisitorCharge_;
};

}  // namespace him
