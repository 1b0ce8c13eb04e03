// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/snapshot.H"

#include "processorPolyPatch.H"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Out of the axes, or of the plane of a side in parts of the box, by this much.
constexpr double tolerance = 1e-6;

enum conditionBit { groundedBit = 1, insulatedBit = 2, otherBit = 4 };

int conditionOf(const Foam::fvPatchScalarField& potential)
{
    if (potential.fixesValue()) {
        return Foam::max(Foam::mag(potential)()) > 0 ? otherBit : groundedBit;
    }
    const std::array<const char*, 3> insulated{"zeroGradient", "symmetryPlane", "symmetry"};
    const auto is = [&](const char* type) { return potential.type() == type; };
    return std::any_of(insulated.begin(), insulated.end(), is) ? insulatedBit : otherBit;
}

/// Side of the box, 2*axis for lower and 2*axis + 1 for upper, on which a face lies; -1 when on none.
int sideOf(const Foam::vector& normal, const Foam::point& centre, const Box& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) > 1 - tolerance) {
            const int side = normal[axis] > 0;
            const double plane = side ? box.upper[axis] : box.lower[axis];
            return std::abs(centre[axis] - plane) < tolerance * box.size()[axis] ? 2 * axis + side : -1;
        }
    }
    return -1;
}

}  // namespace

std::optional<BoxSides> rectangularBox(const snapshot& s)
{
    if (!s.poisson || !s.poisson->chargesAlone()) {
        return {};
    }
    std::array<int, 7> found{};  // conditions on every side; the last of faces on none
    for (const Foam::fvPatchScalarField& potential : s.poisson->electricPotential().boundaryField()) {
        if (potential.coupled() || potential.size() == 0) {
            continue;
        }
        const Foam::vectorField normal(potential.patch().nf());
        forAll(normal, face)
        {
            const int side = sideOf(normal[face], potential.patch().Cf()[face], s.box);
            found[static_cast<std::size_t>(side < 0 ? 6 : side)] |= conditionOf(potential);
        }
    }
    for (int& conditions : found) {
        Foam::reduce(conditions, Foam::bitOrOp<int>());
    }
    const double volume = Foam::gSum(s.mesh().cellVolumes());
    bool fits = found[6] == 0 && std::abs(volume / s.box.size().prod() - 1) < tolerance;
    BoxSides sides;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t side = 0; side < 2; ++side) {
            const int conditions = found[2 * axis + side];
            BoxSide& result = side ? sides.upper[axis] : sides.lower[axis];
            if (s.periodic[axis]) {
                result = BoxSide::periodic;
                fits = fits && conditions == 0;
            } else {
                result = conditions == insulatedBit ? BoxSide::insulated : BoxSide::grounded;
                fits = fits && (conditions == insulatedBit || conditions == groundedBit);
            }
        }
    }
    return fits ? std::optional<BoxSides>(sides) : std::nullopt;
}

std::optional<sphericalSpace> groundedSphere(const snapshot& s)
{
    if (!s.poisson || !s.poisson->chargesAlone()) {
        return {};
    }
    sphericalSpace sphere;
    sphere.centre = 0.5 * (s.box.lower + s.box.upper);
    sphere.radius = 0.5 * s.box.size().maxCoeff();
    const Foam::point centre(sphere.centre.x(), sphere.centre.y(), sphere.centre.z());
    bool fits = true;
    for (const Foam::fvPatchScalarField& potential : s.poisson->electricPotential().boundaryField()) {
        const Foam::polyPatch& patch = potential.patch().patch();
        if (Foam::isA<Foam::processorPolyPatch>(patch)) {
            continue;
        }
        fits = fits && (patch.empty() || (!potential.coupled() && conditionOf(potential) == groundedBit));
        for (const Foam::point& point : patch.localPoints()) {
            fits = fits && std::abs(Foam::mag(point - centre) / sphere.radius - 1) < tolerance;
        }
    }
    return Foam::returnReduce(fits, Foam::andOp<bool>()) ? std::optional<sphericalSpace>(sphere) : std::nullopt;
}

}  // namespace him
