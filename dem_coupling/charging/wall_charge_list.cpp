// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/wall_charge_list.hpp"

namespace him {

void WallChargeList::add(const std::vector<ChargeTransfer::WallGain>& gains, const double* const* centres,
                         const double* radii)
{
    next_.clear();
    auto known = last_.begin();
    for (const ChargeTransfer::WallGain& gain : gains) {
        // Both lists follow the rows, so one walk along them finds every contact again. Out of order it would find fewer.
        while (known != last_.end() && known->particle < gain.particle) {
            ++known;
        }
        const double radius = radii[gain.particle];
        const Vector3 point = Vector3(centres[gain.particle]) + radius * Vector3(gain.normal);
        std::size_t entry = entries_.size();
        for (auto same = known; same != last_.end() && same->particle == gain.particle; ++same) {
            const WallCharge& before = entries_[same->entry];
            const double apart = samePoint * radius;
            if (before.wall == gain.wall && (before.point - point).squaredNorm() <= apart * apart) {
                entry = same->entry;
            }
        }
        if (entry == entries_.size()) {
            entries_.push_back({point, gain.wall, 0});
        }
        entries_[entry].charge += gain.charge;
        next_.push_back({gain.particle, entry});
    }
    last_.swap(next_);
}

void WallChargeList::take(std::vector<WallCharge>& out)
{
    out.clear();
    out.swap(entries_);
    last_.clear();
}

}  // namespace him
