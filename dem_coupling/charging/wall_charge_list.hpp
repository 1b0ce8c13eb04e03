// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charge_transfer.hpp"
#include "dem_coupling/dem_port.hpp"

#include <cstddef>
#include <vector>

namespace him {

/// What contacts have left on insulating walls, until the host takes it. The host seeks the face of every entry, and a contact
/// grows through many steps while its point hardly moves, so its gains of consecutive steps are one entry.
class WallChargeList {
public:
    /// A contact whose point is further than this share of its particle's radius from that of its entry begins a new one: the
    /// place of a charge is known to that.
    static constexpr double samePoint = 0.02;

    /// The gains of one step.
    /// @param centres, radii  of the particles' rows [m]
    void add(const std::vector<ChargeTransfer::WallGain>& gains, const double* const* centres, const double* radii);
    /// Every contact begins a new entry: rows have moved. When that happens does not depend on how the domain is cut.
    void separate() { last_.clear(); }
    /// Hands over all entries and forgets them.
    void take(std::vector<WallCharge>& out);

private:
    /// A contact that grew in the last step.
    struct Growing {
        int particle;
        std::size_t entry;
    };

    std::vector<WallCharge> entries_;
    std::vector<Growing> last_, next_;
};

}  // namespace him
