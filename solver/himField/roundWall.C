// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/roundWall.H"

#include "foamPoissonMesh/conversions.H"

#include "symmTensor.H"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace him {

namespace {

/// Sine of the angle that a face of the side may be inclined to the axis, and one of the ends to the plane across it.
constexpr double inclination = 1e-3;

/// The planes of the side's facets touch one circle, and its points lie on one, up to this part of the radius.
constexpr double outOfRound = 0.02;

/// The middle of a facet lies at most this part of the radius inside the circle of its corners: a dozen facets. With fewer the
/// mesh is a prism.
constexpr double deepestFacet = 0.04;

/// The faces of an end lie in one plane up to this part of the size of the mesh.
constexpr double outOfPlane = 1e-5;

/// Calls work(unit normal, centre, area, points) for every face of this rank that is not coupled.
template <class Work> void forFaces(const foamPoissonMesh& poisson, const Work& work)
{
    for (const Foam::fvPatchScalarField& potential : poisson.electricPotential().boundaryField()) {
        const Foam::fvPatch& patch = potential.patch();
        if (potential.coupled() || patch.size() == 0) {
            continue;
        }
        const Foam::vectorField normal(patch.nf());
        forAll(normal, face)
        {
            work(normal[face], patch.Cf()[face], patch.magSf()[face], patch.patch()[face]);
        }
    }
}

bool across(const Foam::vector& normal, const Foam::vector& axis)
{
    return std::abs(normal & axis) < inclination;
}

bool along(const Foam::vector& normal, const Foam::vector& axis)
{
    return Foam::mag(normal ^ axis) < inclination;
}

/// The vector of the rank with the largest weight, the first of equals. Collective.
Foam::vector heaviest(const Foam::vector& own, double weight)
{
    Foam::List<Foam::vector> vectors(Foam::Pstream::nProcs());
    Foam::List<Foam::scalar> weights(Foam::Pstream::nProcs());
    vectors[Foam::Pstream::myProcNo()] = own;
    weights[Foam::Pstream::myProcNo()] = weight;
    Foam::Pstream::gatherList(vectors);
    Foam::Pstream::scatterList(vectors);
    Foam::Pstream::gatherList(weights);
    Foam::Pstream::scatterList(weights);
    return vectors[static_cast<Foam::label>(std::max_element(weights.begin(), weights.end()) - weights.begin())];
}

/// Directions of which one is the axis of a cylinder. Of two faces at the widest angle one is an end, whose normal the axis is, or
/// both are on the side, and the axis stands at right angles to both normals. (The principal directions of all normals
/// would not do: a cylinder as long as it is wide has none.) Collective.
std::array<Foam::vector, 3> possibleAxes(const foamPoissonMesh& poisson)
{
    Foam::vector first(Foam::Zero);
    forFaces(poisson,
             [&](const Foam::vector& normal, const auto&...) { first = Foam::mag(first) > 0 ? first : normal; });
    first = heaviest(first, Foam::mag(first));
    Foam::vector second = first;
    double widest = 0;
    forFaces(poisson, [&](const Foam::vector& normal, const auto&...) {
        const double sine = Foam::mag(first ^ normal);
        if (sine > widest) {
            widest = sine;
            second = normal;
        }
    });
    second = heaviest(second, widest);
    const Foam::vector third = first ^ second;
    return {first, second, third / std::max(Foam::mag(third), Foam::VSMALL)};
}

/// The axis to which every face is parallel or perpendicular, some of them parallel; where there are ends it is the mean of
/// their normals. Collective.
std::optional<Foam::vector> axisOf(const foamPoissonMesh& poisson)
{
    for (const Foam::vector& axis : possibleAxes(poisson)) {
        bool fits = true;
        Foam::label sides = 0;
        Foam::vector ends(Foam::Zero);
        forFaces(poisson, [&](const Foam::vector& normal, const Foam::point&, double area, const Foam::face&) {
            const bool side = across(normal, axis);
            fits = fits && (side || along(normal, axis));
            sides += side;
            ends += side ? Foam::vector(Foam::Zero) : area * Foam::sign(normal & axis) * normal;
        });
        Foam::reduce(fits, Foam::andOp<bool>());
        Foam::reduce(sides, Foam::sumOp<Foam::label>());
        Foam::reduce(ends, Foam::sumOp<Foam::vector>());
        if (fits && sides > 0) {
            return Foam::mag(ends) > 0 ? ends / Foam::mag(ends) : axis;
        }
    }
    return {};
}

Foam::vector perpendicularTo(const Foam::vector& axis)
{
    // From the direction that the axis points to least.
    Foam::vector direction(Foam::Zero);
    direction[Foam::findMin(Foam::cmptMag(axis))] = 1;
    const Foam::vector found = direction ^ axis;
    return found / Foam::mag(found);
}

struct circle {
    Foam::point centre;  ///< a point of the axis
    double radius;
};

/// The circle that the planes of the side touch with the least mean square of n.x - n.c - r, weighted by area; nothing when some miss
/// it by more than outOfRound. Collective.
std::optional<circle> inscribedCircle(const foamPoissonMesh& poisson, const Foam::vector& axis,
                                      const Foam::point& origin)
{
    const Foam::vector e1 = perpendicularTo(axis);
    const Foam::vector e2 = axis ^ e1;
    Foam::symmTensor normalMatrix(Foam::Zero);
    Foam::vector right(Foam::Zero);
    double total = 0;
    forFaces(poisson, [&](const Foam::vector& normal, const Foam::point& centre, double area, const Foam::face&) {
        if (across(normal, axis)) {
            const Foam::vector row(normal & e1, normal & e2, 1);
            normalMatrix += area * Foam::sqr(row);
            right += area * (normal & (centre - origin)) * row;
            total += area;
        }
    });
    Foam::reduce(normalMatrix, Foam::sumOp<Foam::symmTensor>());
    Foam::reduce(right, Foam::sumOp<Foam::vector>());
    Foam::reduce(total, Foam::sumOp<double>());
    normalMatrix /= total;
    // A quarter all round a circle; next to nothing when the normals point to one side only.
    if (Foam::det(normalMatrix) < 1e-3) {
        return {};
    }
    const Foam::vector solution = Foam::inv(normalMatrix) & (right / total);
    const circle found{origin + solution.x() * e1 + solution.y() * e2, solution.z()};
    bool round = found.radius > 0;  // below: the mesh is outside of the cylinder
    forFaces(poisson, [&](const Foam::vector& normal, const Foam::point& centre, double, const Foam::face&) {
        const double miss = (normal & (centre - found.centre)) - found.radius;
        round = round && (!across(normal, axis) || std::abs(miss) < outOfRound * found.radius);
    });
    return Foam::returnReduce(round, Foam::andOp<bool>()) ? std::optional<circle>(found) : std::nullopt;
}

/// The radius of the side's outermost points, or 0 when these are not on one circle, or deep facets between them. Collective.
double outerRadius(const foamPoissonMesh& poisson, const Foam::vector& axis, const circle& inscribed)
{
    double nearest = Foam::GREAT;
    double farthest = 0;
    const Foam::pointField& points = poisson.mesh().points();
    forFaces(poisson, [&](const Foam::vector& normal, const Foam::point&, double, const Foam::face& face) {
        if (across(normal, axis)) {
            for (const Foam::label point : face) {
                const double radius = Foam::mag((points[point] - inscribed.centre) ^ axis);
                nearest = std::min(nearest, radius);
                farthest = std::max(farthest, radius);
            }
        }
    });
    Foam::reduce(nearest, Foam::minOp<double>());
    Foam::reduce(farthest, Foam::maxOp<double>());
    const bool round = nearest > (1 - outOfRound) * farthest && inscribed.radius > (1 - deepestFacet) * farthest;
    return round ? farthest : 0;
}

/// The ends, none to two; nothing when faces of one side are not in one plane. Collective.
std::optional<std::vector<ImageWall>> flatEnds(const foamPoissonMesh& poisson, const Foam::vector& axis,
                                               const Foam::point& origin)
{
    const double tolerance = outOfPlane * poisson.globalBounds().size().norm();
    std::vector<ImageWall> ends;
    for (const double sign : {-1.0, 1.0}) {
        double lowest = Foam::GREAT;
        double highest = -Foam::GREAT;
        forFaces(poisson, [&](const Foam::vector& normal, const Foam::point& centre, double, const Foam::face&) {
            if (along(normal, axis) && sign * (normal & axis) > 0) {
                const double height = (centre - origin) & axis;
                lowest = std::min(lowest, height);
                highest = std::max(highest, height);
            }
        });
        Foam::reduce(lowest, Foam::minOp<double>());
        Foam::reduce(highest, Foam::maxOp<double>());
        if (highest - lowest > tolerance) {
            return {};
        }
        if (highest >= lowest) {
            ImageWall end;
            end.name = sign > 0 ? "upper end" : "lower end";
            end.point = toEigen(origin + 0.5 * (lowest + highest) * axis);
            end.normal = toEigen(sign * axis);
            ends.push_back(end);
        }
    }
    return ends;
}

}  // namespace

std::vector<ImageWall> findRoundWall(const foamPoissonMesh& mesh)
{
    const std::optional<Foam::vector> axis = axisOf(mesh);
    if (!axis) {
        return {};
    }
    const Box bounds = mesh.globalBounds();
    const Foam::point origin = toFoam(0.5 * (bounds.lower + bounds.upper));
    const std::optional<circle> inscribed = inscribedCircle(mesh, *axis, origin);
    const double radius = inscribed ? outerRadius(mesh, *axis, *inscribed) : 0;
    const std::optional<std::vector<ImageWall>> ends = flatEnds(mesh, *axis, origin);
    if (radius == 0 || !ends) {
        return {};
    }
    ImageWall side;
    side.name = "round side";
    side.shape = ImageWall::Shape::cylinder;
    side.point = toEigen(inscribed->centre);
    side.normal = toEigen(*axis);
    side.radius = radius;
    std::vector<ImageWall> walls{side};
    walls.insert(walls.end(), ends->begin(), ends->end());
    return walls;
}

}  // namespace him
