// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/near_precision.hpp"
#include "electrostatics/types.hpp"

#include <limits>
#include <string>
#include <vector>

namespace him {

/// What to do with a particle that the DEM still has but that no mesh cell holds.
enum class OutsideMesh {
    error,    ///< stop and name the particle
    excluded  ///< it neither gives charge to the mesh nor sees the mesh field; counted and reported
};

/// A grounded wall that a mesh-free method mirrors charges at.
struct ImageWall {
    std::string name;
    enum class Shape { plane, cylinder } shape = Shape::plane;
    Vector3 point = Vector3::Zero();   ///< on the plane, or on the axis [m]
    Vector3 normal = Vector3::Zero();  ///< unit: out of the space of the particles, or along the axis
    double radius = 0;                 ///< of the cylinder [m]; particles are inside
};

struct PairwiseSumSettings {
    bool images = false;                                          ///< mirror charges at imageWalls
    double truncation = std::numeric_limits<double>::infinity();  ///< leave out pairs (and images) farther apart [m]
    std::vector<ImageWall> imageWalls;                            ///< from the DEM scene
};

/// What becomes of the field that the mesh makes of a particle in its own cell.
enum class OwnCellResponse {
    keep,       ///< as published
    forceOnly,  ///< it acts in the force, charging does not see it
    remove      ///< taken out of the field
};

struct HimSettings {
    OwnCellResponse ownCellResponse = OwnCellResponse::keep;
};

struct HimCellSettings {
    double deltaMin = 0;  ///< cells nearer than this [m] interact pair by pair (S section 3)
};

enum class PolynomialOrder { cubic = 3, quartic = 4 };

struct P3mSettings {
    double cloudRadius = 0;  ///< R [m]; 0: cloudCells times the largest cell size where particles are
    double cloudCells = 2;   ///< R in cells, used when cloudRadius is 0
    int cloudExponent = 0;   ///< k of (1 - (r/R)^2)^k, 1 or 2; 0: 1 below R = 2.3 cells, else 2
    PolynomialOrder gather = PolynomialOrder::cubic;
    bool deferredCorrection = false;
    bool selfTerm = false;  ///< subtract the interpolation of the particle's own cloud
    NearPrecision nearPrecision = NearPrecision::doublePrecision;  ///< arithmetic of the near sum
};

/// nearField: how the held field follows the particles between two updates, see NearFieldRefresh.
struct NearFieldSettings {
    long interval = 0;  ///< DEM steps between two computations of the short-range part; 0: it is held like the rest
    double reach = 0;   ///< radius of the short-range part [m]
};

/// Settings of every method; a method reads only what it knows.
struct FieldSettings {
    std::string method;                       ///< run-time selected name
    double accuracy = 0;                      ///< relative RMS field error asked for; 0: none
    double cellsPerDiameter = 0;              ///< mean particle diameter over cell size; 0: unknown. For expectedError
    double nearCutoff = 0;                    ///< r_c [m] of him, directTruncation, hybridParticleCell
    double permittivity = 0;                  ///< eps [F/m]
    Vector3 externalField = Vector3::Zero();  ///< [V/m], added to every method's field
    /// Where no wall is at a voltage, a net charge on the mesh gets a uniform charge density against it.
    bool neutralisingBackground = false;
    OutsideMesh outsideMesh = OutsideMesh::error;
    bool ownResponse = true;  ///< compute ParticleField::ownResponse, which charging at walls needs
    NearFieldSettings nearField;
    PairwiseSumSettings pairwiseSum;
    HimSettings him;
    HimCellSettings himCell;
    P3mSettings p3m;
};

}  // namespace him
