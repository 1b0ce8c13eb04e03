// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/dem_port.hpp"
#include "dem_coupling/field_settings.hpp"
#include "dem_coupling/poisson_mesh.hpp"

#include <array>
#include <mpi.h>
#include <optional>

namespace him {

/// Field method for a relative RMS field error [-], and the error that it was measured to have.
struct AccuracyChoice {
    P3mSettings p3m;
    double expected = 0;  ///< RMS|E - E_exact|/RMS|E_exact|, worst of the measured scenes with plane walls
};

/// Smallest error that chooseForAccuracy can promise. Below one diameter the error grows as diameter over cell size: measured
/// .106 at half a diameter where cells of one diameter have .053 (dense, R = 2 cells), at most that for larger clouds.
double smallestAccuracy(double cellsPerDiameter = 1);

/// Error in a sphere of nine diameters, cells of one diameter: the flat faces of the mesh make it, whatever the clouds are.
constexpr double curvedWallError = 0.016;

/// The cheapest setting of p3m whose error was at most `accuracy` in every measured scene with plane walls: clouds of +-q and
/// of like charges, beds, wall layers, on cells of one and two particle diameters, hexahedral and polyhedral
/// (cases/speedAgainstError/doc/report.md), larger for cells smaller than a particle. Sums pairs in single precision.
/// Throws std::invalid_argument unless accuracy >= smallestAccuracy(cellsPerDiameter).
AccuracyChoice chooseForAccuracy(double accuracy, double cellsPerDiameter = 1);

/// Mean particle diameter over the size of the largest cell in the DEM box; 0 without particles. Collective.
double cellsPerDiameter(const DemParticles& particles, const PoissonMesh& mesh, const Box& demBox,
                        MPI_Comm communicator);

/// Error of the pair sum with the first images between parallel planes, whose images of images it leaves out: worst of a bed, a
/// cloud and wall layers of 1e3 to 1e4 charges in a grounded box.
constexpr double errorBetweenParallelWalls = 0.015;

/// Whether all pairs with the first images of a box cost less time than p3m solved directly in it. From the times per pair, per
/// particle and per cell of cases/speedAgainstError.
bool pairSumIsCheaper(Index particles, Index cells);

/// The box of a mesh whose six sides are grounded conductors, which is all that the pair sum's images serve; nothing for any
/// other mesh. Collective.
std::optional<Box> groundedBox(const PoissonMesh& mesh, const std::array<bool, 3>& periodic, MPI_Comm communicator);

/// The six sides of a box as walls to mirror at.
std::vector<ImageWall> wallsOf(const Box& box);

/// Error that was measured for settings like these in the worst scene with plane walls, times settings.cellsPerDiameter where
/// that is above 1. For pairwiseSum: 0 where it is exact,
/// without walls or with planes of which no two are parallel. NaN where nobody has measured it: other methods, clouds in
/// metres, a plain gather with large clouds, images in cylinders, truncated sums.
double expectedError(const FieldSettings& settings);

}  // namespace him
