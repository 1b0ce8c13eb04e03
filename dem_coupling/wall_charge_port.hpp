// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"

#include <vector>

namespace him {

/// Where the charge of insulating walls lies: on faces of the mesh.
class WallChargePort {
public:
    virtual ~WallChargePort() = default;

    /// Adds the charge of this rank's contacts to the faces under them. Throws std::runtime_error, the same on every rank,
    /// when a contact is at no face. Collective.
    virtual void add(const std::vector<WallCharge>& charges) = 0;
    /// Charge on all faces of all ranks [C]. Collective.
    virtual double total() const = 0;
    /// Whether the faces go on with the charge of an earlier run.
    virtual bool continued() const { return true; }
    /// Whether a DEM wall, by its row in DemPort::walls(), keeps its charge on faces.
    virtual bool keeps(std::size_t demWall) const = 0;

    // --- for projective charging
    /// Remembers the charge of every face.
    virtual void mark() {}
    /// Sum over all faces of all ranks of |charge now - charge at the mark| [C]. Collective.
    virtual double activity() const { return 0; }
    /// Adds to every face times (charge now - charge at the mark) + perActivity |charge now - charge at the mark|. Collective.
    virtual void continueSinceMark(double times, double perActivity)
    {
        static_cast<void>(times);
        static_cast<void>(perActivity);
    }
};

}  // namespace him
