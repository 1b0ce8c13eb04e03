// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_error/box_of_mesh.hpp"

#include <cmath>

namespace him {

namespace {

/// Out of the axes, or of the plane of a side in parts of the box, by this much.
constexpr double tolerance = 1e-6;

enum ConditionBit { groundedBit = 1, insulatedBit = 2, otherBit = 4 };

/// Bounds of the cells of all ranks. Collective.
Box boundsOfAll(const PoissonMesh& mesh, MPI_Comm communicator)
{
    const Box mine = mesh.localBounds();  // empty: +max and -max, which change nothing
    Box all;
    MPI_Allreduce(mine.lower.data(), all.lower.data(), 3, MPI_DOUBLE, MPI_MIN, communicator);
    MPI_Allreduce(mine.upper.data(), all.upper.data(), 3, MPI_DOUBLE, MPI_MAX, communicator);
    return all;
}

/// Side of the box, 2*axis for lower and 2*axis + 1 for upper, on which a face lies; 6 when on none.
std::size_t sideOf(const Vector3& normal, const Vector3& centre, const Box& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) > 1 - tolerance) {
            const bool upper = normal[axis] > 0;
            const double plane = upper ? box.upper[axis] : box.lower[axis];
            const bool onSide = std::abs(centre[axis] - plane) < tolerance * box.size()[axis];
            return onSide ? static_cast<std::size_t>(2 * axis + (upper ? 1 : 0)) : 6;
        }
    }
    return 6;
}

}  // namespace

std::optional<RectangularSpace> boxOfMesh(const PoissonMesh& mesh, const std::array<bool, 3>& periodic,
                                          MPI_Comm communicator)
{
    if (!mesh.chargesAlone()) {
        return {};
    }
    RectangularSpace space;
    space.box = boundsOfAll(mesh, communicator);
    const MeshArrays& arrays = mesh.arrays();
    std::array<int, 7> conditions{};  // found on every side; the last: faces on none
    for (Index face = 0; face < arrays.boundary.size(); ++face) {
        const auto n = static_cast<std::size_t>(face);
        const std::size_t side =
            sideOf(arrays.boundary.normal.row(face).matrix(), arrays.boundary.centre.row(face).matrix(), space.box);
        const FaceCondition condition = arrays.boundary.condition[n];
        const bool grounded = condition == FaceCondition::conductor && arrays.boundary.value[face] == 0;
        conditions[side] |= condition == FaceCondition::insulated ? insulatedBit : grounded ? groundedBit : otherBit;
    }
    MPI_Allreduce(MPI_IN_PLACE, conditions.data(), 7, MPI_INT, MPI_BOR, communicator);
    double volume = arrays.volume.sum();
    MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPI_DOUBLE, MPI_SUM, communicator);

    bool fits = conditions[6] == 0 && !space.box.empty() && std::abs(volume / space.box.size().prod() - 1) < tolerance;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t side = 0; side < 2; ++side) {
            const int found = conditions[2 * axis + side];
            BoxSide& result = side == 1 ? space.sides.upper[axis] : space.sides.lower[axis];
            if (periodic[axis]) {
                result = BoxSide::periodic;
                fits = fits && found == 0;
            } else {
                result = found == insulatedBit ? BoxSide::insulated : BoxSide::grounded;
                fits = fits && (found == insulatedBit || found == groundedBit);
            }
        }
    }
    return fits ? std::optional<RectangularSpace>(space) : std::nullopt;
}

}  // namespace him
