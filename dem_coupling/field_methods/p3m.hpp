// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/exchange/particles_on_mesh.hpp"
#include "dem_coupling/field_method.hpp"
#include "dem_coupling/field_methods/charged_walls.hpp"
#include "dem_coupling/field_methods/own_response_table.hpp"
#include "dem_coupling/field_methods/wall_images.hpp"
#include "electrostatics/near_field.hpp"
#include "electrostatics/p3m/cloud.hpp"
#include "electrostatics/p3m/cloud_deposit.hpp"
#include "electrostatics/p3m/polynomial_gather.hpp"

#include <optional>
#include <unordered_map>

namespace him {

/// `p3m`: every charge is split into a short-range part, summed over pairs, and a smooth cloud whose potential the mesh
/// solves for. Charges near planar walls bring their images into both parts; what images do not carry (curved walls,
/// electrodes, edges) enters the mesh potential through its boundary values. See doc/p3m.md.
class P3m : public FieldMethod, public PointField {
public:
    /// Collective. `mesh` outlives the method.
    P3m(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox, const std::array<bool, 3>& periodic,
        MPI_Comm communicator, PhaseTimes& times);

    /// h [m]: cube root of the volume of the largest cell whose centre lies in the DEM box. Collective.
    static double cellSize(const MeshArrays& mesh, const Box& demBox, MPI_Comm communicator);

    void compute(const DemParticles& particles, ParticleField& result) override;
    double partnerCutoff() const override;
    bool hasPotential() const override { return true; }
    std::string ownResponseText() const override;
    PointField* pointField() override
    {
        wantsPoints_ = true;
        return this;
    }
    /// Of the charges last given to compute(), whatever `sources` holds.
    void fieldOfOthers(const DemParticles& sources, const Points& points, const std::vector<int>& leftOut,
                       Points& field) override;

    double cloudRadius() const { return radius_; }

private:
    /// Decides how ParticleField::ownResponse is found, and makes what of the table is needed. Collective.
    void prepareOwnResponse(const DemParticles& particles);
    void depositAndSolve();
    void solveMesh(const Scalars& cellCharge, Scalars& boundaryValue, Scalars& cellPotential);
    void setBoundaryValues();
    void sumNear(ParticleField& result);
    void addHiddenPairs();
    void gatherAtTargets();
    Vector3 ownCloudGradient(Index target);
    void addOwnImages(Index target);
    Vector3 ownFieldFromTable(Index target);
    /// Keeps what fieldOfOthers() needs; refuses scenes in which it can not be told. Collective.
    void preparePoints();
    Vector3 shortRangeAt(const Vector3& point, Index row) const;
    Vector3 meshFieldOfOthers(const Vector3& point, Index target);
    /// The shortest of the vectors that lead to a point and its periodic copies [m].
    Vector3 shortest(Vector3 way) const;

    FieldSettings settings_;
    Vector3 period_;  ///< of the DEM box [m]; 0 in directions that are not periodic
    PoissonMesh& mesh_;
    MPI_Comm communicator_;
    PhaseTimes& times_;
    double cellSize_;
    double reachOfCells_;  ///< largest distance of a cell's points from its centre, where particles are [m]
    double radius_;        ///< R [m]
    int exponent_;
    MeshLocator locator_;
    MeshHalo halo_;
    SurroundingsTable surroundings_;
    CloudDeposit deposit_;
    PolynomialGather gather_;
    ChargedWalls walls_;
    NearField near_;
    ChargeCloud cloud_;
    ParticlesOnMesh particlesOnMesh_;
    bool matched_ = false;     ///< the mesh solves with the operator that is matched to the gather
    bool correct_ = false;     ///< deferred correction by a second solve
    WallImages planes_;        ///< of a convex mesh with plane conducting sides, else none
    bool faceValues_ = false;  ///< some boundary face, on any rank, has a value besides the case's own

    double largestDiameter_ = 0;  ///< of all particles [m]
    /// Cells are smaller than the largest particle so far: what the mesh makes of its own cloud matters to charging.
    bool fineCells_ = false;
    bool tableSought_ = false;
    std::unique_ptr<OwnResponseTable> ownTable_;

    bool wantsPoints_ = false;
    std::unordered_map<int, Index> targetOfTag_;
    LinkedCells pointCells_;

    CloudSources sources_;
    ChargedPoints points_;
    std::vector<bool> hides_;
    LinkedCells targetCells_;
    DemParticles inCells_;  ///< the targets, for messages
    PairSumResult sums_;
    Scalars cellCharge_, cellPotential_, boundaryValue_, scratchCells_, scratchFaces_, ownCharge_;
    /// Of the targets: field (3), potential, own response (3).
    Eigen::ArrayXXd atTargets_;
};

}  // namespace him
