// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/hybrid_particle_cell.hpp"

#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace him {

namespace {

constexpr std::array<bool, 3> open{false, false, false};
constexpr double roundOff = 1e-9;
constexpr int payload = 4;  // centroid, charge

}  // namespace

HybridParticleCell::HybridParticleCell(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox,
                                       MPI_Comm communicator, PhaseTimes& times)
    : settings_(settings),
      communicator_(communicator),
      times_(times),
      cells_(mesh, settings.nearCutoff * (1 + 2 * roundOff), demBox, open, communicator),
      near_(settings.permittivity)
{
    cells_.findNear(
        [this](const LocalMesh& local, Index a, Index b) { return isNear(local.centreOf(a), local.centreOf(b)); });
}

bool HybridParticleCell::isNear(const Vector3& a, const Vector3& b) const
{
    const double cutoff = settings_.nearCutoff * (1 + roundOff);
    return (a - b).squaredNorm() <= cutoff * cutoff;
}

void HybridParticleCell::compute(const DemParticles& particles, ParticleField& result)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        cells_.locate(particles);
        findOutside(cells_.locator(), particles, communicator_, result);
        if (result.excludedCount > 0 && settings_.outsideMesh == OutsideMesh::error) {
            refuseOutside("hybridParticleCell", cells_.locator(), particles, result.excludedCount, communicator_);
        }
        cells_.distribute(particles);
        gatherOccupiedCells();
    }
    std::string failure;
    sums_.pairs = 0;
    try {
        const PhaseTimer timer(times_, Phase::near);
        near_.coulomb(cells_.charges(), cells_.near(), sums_);
        addFarCells();
    } catch (const std::domain_error& error) {
        failure = error.what();
    }
    result.pairs = sumPairs(sums_.pairs, failure, failure.empty() ? particles : cells_.targetsForMessages(),
                            cells_.charges().position, communicator_);
    const PhaseTimer timer(times_, Phase::exchange);
    atTargets_.resize(sums_.field.rows(), 4);
    atTargets_.leftCols(3) = sums_.field;
    atTargets_.col(3) = sums_.potential;
    result.field.resize(particles.size(), 3);
    result.potential.resize(particles.size());
    cells_.bringBack(atTargets_, [&](Index row, const double* values) {
        result.field.row(row) << values[0], values[1], values[2];
        result.potential[row] = values[3];
    });
    result.ownResponse.resize(0, 3);
    addExternalField(settings_.externalField, result);
    addExternalPotential(settings_.externalField, particles, result);
}

void HybridParticleCell::gatherOccupiedCells()
{
    const ChargesInCells& charges = cells_.charges();
    charges.sumCells(cellCharge_);
    sent_.clear();
    for (Index cell = 0; cell < charges.ownCells; ++cell) {
        const RowRange rows = charges.rowsOf(cell);
        if (rows.begin != rows.end) {
            const Vector3 centre = cells_.mesh().centreOf(cell);
            sent_.insert(sent_.end(), {centre[0], centre[1], centre[2], cellCharge_[cell]});
        }
    }
    int ranks = 1;
    MPI_Comm_size(communicator_, &ranks);
    std::vector<int> counts(static_cast<std::size_t>(ranks)), starts(static_cast<std::size_t>(ranks));
    const int mine = static_cast<int>(sent_.size());
    MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator_);
    std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
    received_.resize(static_cast<std::size_t>(starts.back() + counts.back()));
    MPI_Allgatherv(sent_.data(), mine, MPI_DOUBLE, received_.data(), counts.data(), starts.data(), MPI_DOUBLE,
                   communicator_);

    far_.count = static_cast<Index>(received_.size()) / payload;
    for (Scalars* values : {&far_.x, &far_.y, &far_.z, &far_.charge}) {
        values->setZero(far_.count + sourcePadding);
    }
    for (Index n = 0; n < far_.count; ++n) {
        const double* in = received_.data() + payload * n;
        far_.x[n] = in[0];
        far_.y[n] = in[1];
        far_.z[n] = in[2];
        far_.charge[n] = in[3];
    }
}

void HybridParticleCell::addFarCells()
{
    const ChargesInCells& charges = cells_.charges();
    const Index targets = charges.targets();
    x_ = charges.position.col(0).head(targets);
    y_ = charges.position.col(1).head(targets);
    z_ = charges.position.col(2).head(targets);
    for (Scalars* values : {&fieldX_, &fieldY_, &fieldZ_, &potential_}) {
        values->setZero(targets);
    }
    const PointArrays sources{far_.x.data(), far_.y.data(), far_.z.data(), far_.charge.data(),
                              nullptr,       nullptr,       nullptr};
    const PointArrays points{x_.data(), y_.data(), z_.data(), charges.charge.data(), nullptr, nullptr, nullptr};
    const SumArrays sums{fieldX_.data(), fieldY_.data(), fieldZ_.data(), potential_.data()};
    PairLimits limits{};
    limits.cutoffSquared = largestCoordinate * largestCoordinate;
    const PairKernels::Law& law = runnablePairKernels().front()->coulomb;
    for (Index cell = 0; cell < charges.ownCells; ++cell) {
        const RowRange rows = charges.rowsOf(cell);
        if (rows.begin == rows.end) {
            continue;
        }
        const Vector3 centre = cells_.mesh().centreOf(cell);
        farRanges_.clear();
        for (Index n = 0; n < far_.count; ++n) {
            if (isNear(centre, {far_.x[n], far_.y[n], far_.z[n]})) {
                continue;
            }
            if (!farRanges_.empty() && farRanges_.back().end == n) {
                ++farRanges_.back().end;
            } else {
                farRanges_.push_back({n, n + 1});
            }
        }
        for (std::ptrdiff_t first = rows.begin; first < rows.end; first += mostTargets) {
            const int count = static_cast<int>(std::min<std::ptrdiff_t>(mostTargets, rows.end - first));
            law.single(points.from(first), count, sums.from(first), sources, farRanges_.data(),
                       static_cast<int>(farRanges_.size()), limits);
        }
    }
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    sums_.field.col(0) += coulombConstant * fieldX_;
    sums_.field.col(1) += coulombConstant * fieldY_;
    sums_.field.col(2) += coulombConstant * fieldZ_;
    sums_.potential += coulombConstant * potential_;
}

}  // namespace him
