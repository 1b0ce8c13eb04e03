// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/charging/contact_recorder.hpp"

#include <cstddef>
#include <vector>

namespace him {

/// A wall contact whose area grew in this step.
struct GrowingWallContact {
    int particle;
    int wall;
    double growth;            ///< dA > 0 [m2]
    double normal[3];         ///< from the particle into the wall
    double area = 0;          ///< now [m2]
    double* moved = nullptr;  ///< charge that this contact has given to the particle since it began [C]
    double fieldNormal = 0;   ///< E_other . n at the contact point, where it is asked for [V/m]
};

/// Contact areas of the last step per (particle, wall, direction). LIGGGHTS keeps contact history per triangle and does
/// not carry it over edges that are not coplanar, so a ball that rolls over a tessellated wall would charge anew at every
/// facet. Here facets whose normals differ by less than an angle are one contact.
class WallContactMemory {
public:
    /// @param curvature  angle [degrees] between normals below which two touches of a wall are one contact; 0 < curvature < 90
    explicit WallContactMemory(double curvature);

    /// Makes room for the rows [0, rows).
    void resize(std::size_t rows) { ranges_.resize(rows); }
    void copyRow(int from, int to);
    void clearRow(int row);

    static constexpr std::size_t contactDoubles = 7;  ///< stored per contact
    /// Doubles needed to store a row, and storing and reading it (migration, restart). Both return the count.
    std::size_t packedSize(int row) const { return 1 + contactDoubles * ranges_[row].count; }
    std::size_t pack(int row, double* buffer) const;
    std::size_t unpack(int row, const double* buffer);

    /// Takes the touches of one step of the rows [0, rows) and lists the contacts that grew. Contacts without a touch end.
    /// The list points into this memory until its next change.
    /// @return number of contacts that began
    std::int64_t update(const std::vector<WallTouch>& touches, int rows, Reloading reloading,
                        std::vector<GrowingWallContact>& growing);

private:
    struct Contact {
        int wall;
        double area;         ///< at the last step [m2]
        double largestArea;  ///< [m2]
        double normal[3];
        double moved;    ///< charge given to the particle since the contact began [C]
        double newArea;  ///< of this step; negative until a touch is seen
    };
    /// Where the contacts of a row stand among all of them.
    struct Range {
        std::size_t first = 0;
        std::size_t count = 0;
    };
    Contact* find(int row, const WallTouch& touch);
    Contact* begin(int row, int wall);
    /// A place for the contacts of a row at the end of all of them; those that it had stay where they were, as nobody's.
    Contact* placeAtEnd(int row, std::size_t count);
    void findOccupied(int rows);
    void layInOrder();

    double cosCurvature_;
    /// Contacts of all rows. The work of a step goes along them in the order of rows; between steps, rows that were moved or
    /// read stand at the end and leave gaps.
    std::vector<Contact> contacts_, next_;
    std::vector<Range> ranges_;  ///< per row
    /// Rows that had contacts after the last update(), in order: few particles of a bed touch a wall.
    std::vector<int> occupied_, merged_;
    bool inOrder_ = true;         ///< contacts_ follow occupied_ without gaps
    bool occupiedKnown_ = false;  ///< false after rows moved or were cleared
    int rowsKnown_ = 0;           ///< of the last update()
};

}  // namespace him
