// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/mesh_halo.hpp"
#include "dem_coupling/poisson_mesh.hpp"
#include "electrostatics/linked_cells.hpp"
#include "electrostatics/p3m/charged_panel.hpp"
#include "electrostatics/p3m/cloud_sources.hpp"

namespace him {

/// Insulating walls inside the mesh as p3m sees them: charges that rest. Every face is a few points which act like particles,
/// through their pairs, clouds and images, so that nothing on the mesh jumps at the wall and stencils go through it. Near a
/// face its points are replaced by the exact field of an evenly charged panel.
class ChargedWalls {
public:
    /// Collective. All but `mesh` are used here only.
    /// @param mesh         outlives this
    /// @param cloudRadius  R [m]
    ChargedWalls(const PoissonMesh& mesh, MeshHalo& halo, SurroundingsTable& table, double cloudRadius);

    /// Whether neither this rank nor one near it has such a wall.
    bool none() const { return faceCell_.empty(); }

    /// Takes the present charge of the faces. Neighbours talk.
    void update(SparseExchange& exchange);

    /// Appends the points of all charged faces as sources that are no targets.
    void appendTo(CloudSources& sources) const;

    /// Adds to field [V/m] and potential [V], one row per target, the exact field of the panels near the targets less the Coulomb
    /// field of the panels' points. Baffles do not hide panels.
    /// @param permittivity  eps [F/m]
    void addNearPanels(const CloudSources& sources, double permittivity, Points& field, Scalars& potential);

private:
    void findNearRuns(const CloudSources& sources);
    /// Points, panels and images of the next face.
    void takeFace(const std::vector<Vector3>& corners, std::int32_t cell, SurroundingsTable& table, double cloudRadius);

    const PoissonMesh& mesh_;
    Index ownFaces_ = 0;
    std::vector<std::vector<std::int32_t>> sentFaces_;  ///< own faces that each rank has copies of
    std::vector<Index> receivedFaces_;                  ///< number of copies here of each rank's faces
    std::vector<std::int32_t> faceCell_;  ///< of the local mesh, at the counted side: own faces, then copies
    Scalars faceCharge_;                  ///< [C]
    SparseExchange::Buffers outgoing_, incoming_;

    struct Point {
        Vector3 position;  ///< [m]
        double share;      ///< of the face's charge
        std::int32_t face;
    };
    std::vector<Point> points_;
    struct Panel {
        ChargedPanel shape;
        std::vector<ChargedPanel::Point> points;
        double share;  ///< of the face's charge, negative for the image in a conductor
        std::int32_t face;
    };
    void addNearPanel(const Panel& panel, double charge, Points& field, Scalars& potential);
    /// Lays the panels in the order of their linked cells, so that those near a target follow one another.
    void orderPanels();
    std::vector<Panel> panels_;  ///< and their images
    LinkedCells panelCells_;
    Points panelCentre_;        ///< [m], all three in the order of panels_
    Scalars panelNearSquared_;  ///< squared distance up to which the panel is exact [m2]
    Scalars panelCharge_;       ///< of update() [C]

    std::vector<RowRange> runs_;  ///< of targets in one cell
    struct NearRun {
        std::int32_t panel, run;
    };
    std::vector<NearRun> found_;                          ///< as they were found, run by run
    std::vector<std::int32_t> nearRuns_, firstNearRun_;   ///< runs near each panel, and where each panel's begin
    FieldAtPlaces nearPlaces_;                            ///< some targets near a panel
    std::array<Index, FieldAtPlaces::most> nearTargets_;  ///< which these are
};

}  // namespace him
