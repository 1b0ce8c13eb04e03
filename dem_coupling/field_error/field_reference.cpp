// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_error.hpp"
#include "dem_coupling/field_error/box_of_mesh.hpp"
#include "dem_coupling/field_error/box_of_walls.hpp"
#include "dem_coupling/field_error/strict_p3m.hpp"
#include "electrostatics/near_field.hpp"

namespace him {

namespace {

/// Accuracy of the exact sum; far below what a method can reach in a run.
constexpr double tolerance = 1e-7;

class BoxReference : public FieldReference {
public:
    BoxReference(const RectangularSpace& space, double permittivity) : box_(space.box, permittivity, space.sides)
    {
        box_.setTolerance(tolerance);
    }
    void addField(const DemParticles& particles, const Points& targets, const std::vector<Index>& ownRow,
                  Points& field) const override
    {
        Points part;
        Scalars potential;
        box_.computeAt(particles.position, particles.charge, targets, ownRow, part, potential);
        field += part;
    }
    std::string description() const override { return "the exact field in the box, all images included"; }

private:
    GroundedBox box_;
};

class AllPairsReference : public FieldReference {
public:
    explicit AllPairsReference(double permittivity) : permittivity_(permittivity) {}
    void addField(const DemParticles& particles, const Points& targets, const std::vector<Index>& ownRow,
                  Points& field) const override
    {
        Scalars potential = Scalars::Zero(1);
        for (Index target = 0; target < targets.rows(); ++target) {
            const Points one = targets.row(target);
            Points part = Points::Zero(1, 3);
            addAllPairs(one, particles.position, particles.charge, ownRow[static_cast<std::size_t>(target)],
                        permittivity_, part, potential);
            field.row(target) += part.row(0);
        }
    }
    std::string description() const override { return "the sum over all pairs, exact in free space"; }

private:
    double permittivity_;
};

}  // namespace

std::unique_ptr<FieldReference> FieldReference::find(const FieldSettings& settings, PoissonMesh* mesh,
                                                     const Box& demBox, const std::array<bool, 3>& periodic,
                                                     MPI_Comm communicator, std::string& reason)
{
    reason =
        "a rectangular box of grounded, insulated or periodic sides has one, and on other meshes a stricter p3m serves";
    if (mesh) {
        if (const auto space = boxOfMesh(*mesh, periodic, communicator)) {
            return std::make_unique<BoxReference>(*space, settings.permittivity);
        }
        reason = StrictP3mReference::whyNot(settings, *mesh, demBox, periodic, communicator);
        if (reason.empty()) {
            return std::make_unique<StrictP3mReference>(settings, *mesh, demBox, periodic, communicator);
        }
        return nullptr;
    }
    if (settings.method == "pairwiseSum" && settings.pairwiseSum.images) {
        if (const auto space = boxOfWalls(settings.pairwiseSum.imageWalls)) {
            return std::make_unique<BoxReference>(*space, settings.permittivity);
        }
    }
    const bool anyPeriodic = periodic[0] || periodic[1] || periodic[2];
    if (settings.method == "directTruncation" && !anyPeriodic) {
        return std::make_unique<AllPairsReference>(settings.permittivity);
    }
    return nullptr;
}

}  // namespace him
