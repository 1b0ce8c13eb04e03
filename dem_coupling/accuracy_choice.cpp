// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/accuracy_choice.hpp"

#include "dem_coupling/field_error/box_of_mesh.hpp"
#include "dem_coupling/field_methods/p3m.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace him {

namespace {

struct Measured {
    double cloudCells;
    PolynomialOrder gather;
    bool deferredCorrection;
    double error;  ///< worst scene, rounded up
};

/// Cheapest first. Worst scenes: dense +-q on cells of one diameter (.053, .011, .0037), a cylinder (.046, .011, .0047), +-q
/// in a polyhedral box (.037, .009, .0034; six cells .0011).
constexpr std::array<Measured, 4> table{{{2, PolynomialOrder::cubic, false, 0.055},
                                         {3, PolynomialOrder::quartic, true, 0.012},
                                         {4, PolynomialOrder::quartic, true, 0.005},
                                         {6, PolynomialOrder::quartic, true, 0.0012}}};

double growth(double cellsPerDiameter)
{
    return std::max(1.0, cellsPerDiameter);
}

}  // namespace

double smallestAccuracy(double cellsPerDiameter)
{
    return table.back().error * growth(cellsPerDiameter);
}

AccuracyChoice chooseForAccuracy(double accuracy, double cellsPerDiameter)
{
    for (const Measured& row : table) {
        const double error = row.error * growth(cellsPerDiameter);
        if (error <= accuracy) {
            AccuracyChoice choice;
            choice.p3m.cloudCells = row.cloudCells;
            choice.p3m.gather = row.gather;
            choice.p3m.deferredCorrection = row.deferredCorrection;
            choice.p3m.nearPrecision = NearPrecision::singlePrecision;
            choice.expected = error;
            return choice;
        }
    }
    throw std::invalid_argument("chooseForAccuracy: accuracy " + std::to_string(accuracy) + " must be at least "
                                + std::to_string(smallestAccuracy(cellsPerDiameter)));
}

double cellsPerDiameter(const DemParticles& particles, const PoissonMesh& mesh, const Box& demBox,
                        MPI_Comm communicator)
{
    double sums[2] = {2 * particles.radius.sum(), static_cast<double>(particles.size())};
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, communicator);
    return sums[1] > 0 ? sums[0] / sums[1] / P3m::cellSize(mesh.arrays(), demBox, communicator) : 0.0;
}

bool pairSumIsCheaper(Index particles, Index cells)
{
    constexpr double perPair = 0.55e-9;  // [s] 11320 charges, all pairs, 71 ms
    constexpr int copies = 27;           // a charge and its images in six walls
    constexpr double perParticle = 1.0e-6;
    constexpr double perCell = 22e-9;
    const auto n = static_cast<double>(particles);
    return copies * perPair * n * n < perParticle * n + perCell * static_cast<double>(cells);
}

std::vector<ImageWall> wallsOf(const Box& box)
{
    std::vector<ImageWall> walls;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            ImageWall wall;
            wall.name = std::string(upper ? "upper " : "lower ") + "xyz"[axis] + " side of the mesh";
            wall.point = upper ? box.upper : box.lower;
            wall.normal = (upper ? 1.0 : -1.0) * Vector3::Unit(axis);
            walls.push_back(wall);
        }
    }
    return walls;
}

std::optional<Box> groundedBox(const PoissonMesh& mesh, const std::array<bool, 3>& periodic, MPI_Comm communicator)
{
    const auto space = boxOfMesh(mesh, periodic, communicator);
    const auto grounded = [](BoxSide side) { return side == BoxSide::grounded; };
    if (space && std::all_of(space->sides.lower.begin(), space->sides.lower.end(), grounded)
        && std::all_of(space->sides.upper.begin(), space->sides.upper.end(), grounded)) {
        return space->box;
    }
    return std::nullopt;
}

namespace {

double expectedPairSumError(const PairwiseSumSettings& settings)
{
    const bool planes = std::all_of(settings.imageWalls.begin(), settings.imageWalls.end(),
                                    [](const ImageWall& wall) { return wall.shape == ImageWall::Shape::plane; });
    if (std::isfinite(settings.truncation) || !planes) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    constexpr double almostOne = 1 - 1e-12;
    for (std::size_t a = 0; settings.images && a < settings.imageWalls.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            if (std::abs(settings.imageWalls[a].normal.dot(settings.imageWalls[b].normal)) > almostOne) {
                return errorBetweenParallelWalls;
            }
        }
    }
    return 0;
}

}  // namespace

double expectedError(const FieldSettings& settings)
{
    if (settings.method == "pairwiseSum") {
        return expectedPairSumError(settings.pairwiseSum);
    }
    double error = std::numeric_limits<double>::quiet_NaN();
    const P3mSettings& p3m = settings.p3m;
    if (settings.method != "p3m" || p3m.cloudRadius > 0) {
        return error;
    }
    for (const Measured& row : table) {
        const bool gatherReaches = row.gather == PolynomialOrder::cubic || p3m.gather == PolynomialOrder::quartic;
        const bool corrected = p3m.deferredCorrection || !row.deferredCorrection;
        if (p3m.cloudCells >= row.cloudCells && gatherReaches && corrected) {
            error = row.error * growth(settings.cellsPerDiameter);
        }
    }
    return error;
}

}  // namespace him
