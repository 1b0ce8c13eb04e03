// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/charging_pairs.hpp"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace him {

/// A particle-particle contact whose area grew in this step. Rows are those of the DEM's local and ghost particles.
struct GrowingPair {
    int first;         ///< a particle of this rank
    int second;        ///< its partner, maybe a ghost
    double growth;     ///< dA > 0 [m2]
    double normal[3];  ///< unit vector from first to second
    double area = 0;   ///< now [m2]
    /// Charge that this contact has given to the particle of the lower tag since it began [C]; null where nobody keeps it.
    double* moved = nullptr;
};

/// The growing contacts of one step. A dense bed writes and reads hundreds of thousands of them in every step, which costs as
/// much as memory is slow, so that the numbers of a contact lie apart and those that nobody will read are left out.
class GrowingPairs {
public:
    struct Ends {
        int first;
        int second;
        double growth;
    };
    struct Normal {
        double component[3];
    };
    struct Within {
        double area;
        double* moved;
    };

    GrowingPairs() = default;
    GrowingPairs(const std::vector<GrowingPair>& contacts)
    {
        for (const GrowingPair& contact : contacts) {
            add(contact);
        }
    }
    GrowingPairs(std::initializer_list<GrowingPair> contacts) : GrowingPairs(std::vector<GrowingPair>(contacts)) {}

    /// What to keep of the contacts that are added from now on; everything unless told.
    /// @param normals  for the field at the contact
    /// @param within   GrowingPair::area and moved, for charges that are frozen within a contact
    void keep(bool normals, bool within)
    {
        keepsNormals_ = normals;
        keepsWithin_ = within;
    }
    bool keepsWithin() const { return keepsWithin_; }

    void add(const GrowingPair& contact)
    {
        ends_.push_back({contact.first, contact.second, contact.growth});
        if (keepsNormals_) {
            normals_.push_back({{contact.normal[0], contact.normal[1], contact.normal[2]}});
        }
        if (keepsWithin_) {
            within_.push_back({contact.area, contact.moved});
        }
    }
    void clear()
    {
        ends_.clear();
        normals_.clear();
        within_.clear();
    }

    const std::vector<Ends>& ends() const { return ends_; }
    const double* normal(std::size_t contact) const { return normals_[contact].component; }
    const Within& within(std::size_t contact) const { return within_[contact]; }

private:
    bool keepsNormals_ = true, keepsWithin_ = true;
    std::vector<Ends> ends_;
    std::vector<Normal> normals_;  ///< as many as ends_, or none
    std::vector<Within> within_;
};

/// A particle that touches a wall in this step, growing or not. On a mesh wall one touch per facet.
struct WallTouch {
    int particle;
    int wall;          ///< row of the wall list
    double area;       ///< [m2]
    double normal[3];  ///< unit vector from the particle into the wall
};

/// What the contact model writes down during a force computation and the charging fix works off at the end of the step.
/// The contact model moves no charge itself: it is also called in set-up and by computes.
struct ContactRecorder {
    AreaLaw areaLaw = AreaLaw::hertz;
    double areaFactor = 0;  ///< contact area over effective radius times overlap, of areaLaw
    Reloading reloading = Reloading::counted;
    int movedValue = -1;  ///< where GrowingPair::moved stands among the history values of a contact; -1 when not kept
    int groupBit = 1;     ///< of the particles that charge
    GrowingPairs pairs;
    std::vector<WallTouch> touches;
    std::int64_t pairsBegun = 0;  ///< contacts that began in this step and that this rank counts

    void clear()
    {
        pairs.clear();
        touches.clear();
        pairsBegun = 0;
    }
};

}  // namespace him
