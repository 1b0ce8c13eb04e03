// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/gas/gas_coupling.hpp"
#include "electrostatics/constants.hpp"
#include "tests/support/fake_gas_mesh.hpp"
#include "tests/support/particle_sets.hpp"

#include <array>
#include <cmath>
#include <mpi.h>
#include <random>

namespace him {

// What the tests of the gas coupling share: a box of cells, a thick gas in it, and spheres on all ranks.

inline const Box box{Vector3(0, 0, 0), Vector3(0.04, 0.02, 0.02)};
constexpr std::array<Index, 3> cells{8, 4, 4};  // cubes of 5 mm
constexpr double cellVolume = 5e-3 * 5e-3 * 5e-3;
constexpr double step = 1e-5;

inline GasSettings air(VoidFractionModel model = VoidFractionModel::centre)
{
    GasSettings settings;
    settings.density = 100;
    settings.viscosity = 1e-3;
    settings.drag = "WenYu";
    settings.voidFraction = model;
    settings.smoothingLength = 8e-3;
    return settings;
}

inline double overRanks(double value)
{
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return value;
}

inline Vector3 overRanks(Vector3 value)
{
    MPI_Allreduce(MPI_IN_PLACE, value.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return value;
}

inline void resize(DemParticles& particles, Index rows)
{
    particles.tag.resize(static_cast<std::size_t>(rows));
    particles.type.assign(static_cast<std::size_t>(rows), 1);
    particles.position.conservativeResize(rows, 3);
    particles.velocity.conservativeResize(rows, 3);
    particles.charge.setZero(rows);
    particles.radius.setConstant(rows, 2e-3);
    particles.mass.setConstant(rows, 1000 * 4 * pi / 3 * std::pow(2e-3, 3));
}

/// Spheres of 4 mm that each rank owns a part of, wherever the cells are.
inline DemParticles spheres(int count)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0, 1);
    DemParticles all;
    resize(all, count);
    for (int n = 0; n < count; ++n) {
        all.tag[static_cast<std::size_t>(n)] = n + 1;
        for (int axis = 0; axis < 3; ++axis) {
            all.position(n, axis) = box.size()[axis] * share(random);
            all.velocity(n, axis) = share(random) - 0.5;
        }
    }
    return dealt(all, MPI_COMM_WORLD);
}

/// u = shear (y - y of the cell's centre) along x.
class Shear : public VelocityProfile {
public:
    explicit Shear(const CellMesh& mesh) : mesh_(mesh) {}
    void update(const Points& velocity) override
    {
        ++updates;
        updatedBy = velocity;
    }
    Vector3 deviation(Index cell, const Vector3& point) const override
    {
        return rate * (point - mesh_.cellCentre(cell))[1] * Vector3::UnitX();
    }
    double rate = 300;
    int updates = 0;
    Points updatedBy;

private:
    const CellMesh& mesh_;
};

/// A gas whose cells know nothing of one another: each has a mass and a velocity that its drag changes, implicitly.
class LooseGas {
public:
    LooseGas(const FakeGasMesh& mesh, const GasSettings& settings) : settings_(settings)
    {
        result.velocity.setZero(mesh.cellCount(), 3);
        result.velocity.col(0) = 1;
        result.pressureForce.setZero(mesh.cellCount(), 3);
        perVolume_.setConstant(mesh.cellCount(), settings.density);
    }

    void solve(const GasSources& sources, double duration)
    {
        const Points before = result.velocity;
        for (int axis = 0; axis < 3; ++axis) {
            result.velocity.col(axis) =
                (perVolume_ * before.col(axis) + duration * sources.dragMomentum.col(axis) - sources.owed.col(axis))
                / (perVolume_ + duration * sources.drag);
        }
        const Points change = (before - result.velocity).colwise() * perVolume_;
        result.given = overRanks(Vector3(cellVolume * change.colwise().sum().matrix().transpose()));
    }

    Vector3 momentum() const
    {
        const Points all = result.velocity.colwise() * perVolume_;
        return overRanks(Vector3(cellVolume * all.colwise().sum().matrix().transpose()));
    }

    GasResult result;

private:
    GasSettings settings_;
    Scalars perVolume_;
};

}  // namespace him
