// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/gathered_rows.hpp"
#include "electrostatics/linked_cells.hpp"
#include "electrostatics/near_precision.hpp"
#include "electrostatics/p3m/cloud.hpp"
#include "electrostatics/pair_kernels.hpp"
#include "electrostatics/types.hpp"

#include <cstdint>
#include <limits>

namespace him {

/// The sources of a pair sum. The first `targets` rows are the particles whose field is wanted; the rest are halo
/// copies of other ranks, periodic copies or image charges, which only act. A particle never acts on itself (same row).
struct ChargedPoints {
    Points position;    ///< [m]
    Scalars charge;     ///< [C]
    Points cellCentre;  ///< [m], centre of the mesh cell that holds the point; only for the double-count correction
    Index targets = 0;
};

/// Field [V/m] and potential [V] at the targets, own charge excluded.
struct PairSumResult {
    Points field;
    Scalars potential;
    std::int64_t pairs = 0;  ///< pairs inside the cutoff, counted per target

    void resize(Index targets)
    {
        field.resize(targets, 3);
        potential.resize(targets);
    }
};

/// Pair sums within a cutoff over linked cells: cost linear in the number of points. Scratch memory is kept between
/// calls, so a steady run allocates nothing. The sums throw std::domain_error naming the first row whose position, charge
/// or cell centre is not finite, and std::invalid_argument when the arrays differ in length.
class NearField {
public:
    /// @param cutoff        r_c [m] in 1e-40..1e50; a pair counts when |x_i - x_k| <= r_c
    /// @param permittivity  eps > 0 [F/m]. Throws std::invalid_argument otherwise.
    /// @param kernels       one of runnablePairKernels()
    NearField(double cutoff, double permittivity, const PairKernels& kernels = *runnablePairKernels().front());

    /// R29 over |x_i - x_k| <= r_c (S2.18 with a radius in place of whole cells): E_i = sum q_k (x_i - x_k)/(4 pi eps r^3),
    /// and the potential of the same pairs. Throws std::domain_error naming two rows that share a position.
    void coulomb(const ChargedPoints& points, PairSumResult& result);

    /// The same field plus the double-count correction R31 over the same pairs: minus the Coulomb field between the two
    /// cell centres for pairs in different cells (one index k, as physics demands; R31 prints j and k mixed).
    /// Centres closer than 1e-9 r_c are the same cell. The potential is left at zero: HIM has none.
    void coulombWithoutDoubleCount(const ChargedPoints& points, PairSumResult& result);

    /// The short-range part of charges whose cloud the mesh carries (p3m): E_i = sum q_k (x_i - x_k) (1/r^3 - F(r)) and
    /// V_i = sum q_k (1/r - psi(r)) over r <= R, each times 1/(4 pi eps). Nothing is left of a pair at R, so the sum is
    /// exact, not truncated. Throws std::domain_error naming two rows that share a position.
    /// Single precision errs by less than 1e-6 of the summed magnitudes; forces of a pair are opposite to as much.
    /// @param cloud  its radius R must be the cutoff; std::invalid_argument otherwise
    void screened(const ChargedPoints& points, const ChargeCloud& cloud, PairSumResult& result,
                  NearPrecision precision = NearPrecision::doublePrecision);

    double cutoff() const { return cutoff_; }

private:
    void sort(const ChargedPoints& points, bool withCellCentres, double pointsPerReach);
    /// Consecutive targets of one row of linked cells that are summed together.
    struct TargetBlock {
        Index first;
        int count;
        Box box;
    };
    TargetBlock blockFrom(Index first, Index end, int most, double length) const;
    PairLimits limits() const;
    void sumAtTargets(const ChargedPoints& points, const PairKernels::Law& law, const PairLimits& limits,
                      PairSumResult& result);
    void screenedInSingle(const ChargedPoints& points, const ChargeCloud& cloud, PairSumResult& result);
    void refuseCoincidence(const ChargedPoints& points, const TargetBlock& block) const;

    const PairKernels& kernels_;
    double cutoff_;
    double permittivity_;
    // Targets and the other sources in the order of their linked cells, the targets first. Every array is contiguous and
    // padded for the kernels.
    LinkedCells targets_, others_;
    Scalars x_, y_, z_, q_, cellX_, cellY_, cellZ_;
    Scalars fieldX_, fieldY_, fieldZ_, sumOfPotential_;  ///< without 1/(4 pi eps)
    SingleRows single_;
    GatheredRows gathered_;
};

/// Field and potential at `targets` of all `sources` (R29, method PS), or of those within `cutoff` [m], added to what `field` and
/// `potential` hold. `selfRow` is the row among the sources of the first target, or -1 when the targets are not among
/// them; target t is source selfRow + t. Throws std::domain_error naming two rows that share a position.
/// @return number of pairs summed
std::int64_t addAllPairs(const Points& targets, const Points& sources, const Scalars& charges, Index selfRow,
                         double permittivity, Points& field, Scalars& potential,
                         double cutoff = std::numeric_limits<double>::infinity());

/// Electrostatic energy [J]: U = 1/2 sum q_i V_i, V_i without the particle's own Coulomb term.
double electrostaticEnergy(const Scalars& charge, const Scalars& potential);

}  // namespace him
