// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/sparse_exchange.hpp"
#include "electrostatics/near_field.hpp"

#include <array>

namespace him {

/// Brings to every rank the sources that its near sum needs: copies of all particles of other ranks, and of all
/// periodic copies, that can lie within the cutoff of one of its own particles. Ranks tell each other only the
/// bounding box of their particles.
class ParticleHalo {
public:
    /// @param cutoff    r_c [m]
    /// @param demBox    box [m] whose size is the period in the periodic directions
    ParticleHalo(double cutoff, const Box& demBox, const std::array<bool, 3>& periodic, MPI_Comm communicator);

    /// Appends the copies to `points`, whose rows are this rank's own particles when called; they become the targets.
    /// Cell centres move with their periodic copies. All periodic copies inside the cutoff come, not only the nearest
    /// one, the particle's own included. Collective.
    void extend(ChargedPoints& points);

    /// One more value per particle, for the rows that the last extend() made: `values` holds those of the own rows when
    /// called and those of all rows afterwards. Not collective: only neighbours talk.
    void forward(Scalars& values);

private:
    void shareBounds(const Points& positions);
    void chooseCopies(const Points& positions);

    struct Copy {
        Index row;
        Vector3 shift;
    };

    double cutoff_;
    Vector3 period_;
    std::array<bool, 3> periodic_;
    SparseExchange exchange_;
    std::vector<Box> bounds_;                ///< of every rank's particles
    std::vector<std::vector<Copy>> copies_;  ///< what each rank gets from this one
    SparseExchange::Buffers outgoing_, incoming_, forwardedOut_, forwardedIn_;
};

}  // namespace him
