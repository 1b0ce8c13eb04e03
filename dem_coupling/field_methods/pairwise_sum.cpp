// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_methods/pairwise_sum.hpp"

#include "dem_coupling/field_methods/contact_points.hpp"
#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"
#include "electrostatics/near_field.hpp"

#include <limits>
#include <stdexcept>

namespace him {

PairwiseSum::PairwiseSum(const FieldSettings& settings, MPI_Comm communicator, PhaseTimes& times)
    : settings_(settings), communicator_(communicator), times_(times), walls_(settings.pairwiseSum.imageWalls)
{
}

double PairwiseSum::partnerCutoff() const { return settings_.pairwiseSum.truncation; }

void PairwiseSum::passOn()
{
    const PhaseTimer timer(times_, Phase::exchange);
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(communicator_, &rank);
    MPI_Comm_size(communicator_, &ranks);
    const int next = (rank + 1) % ranks;
    const int previous = (rank + ranks - 1) % ranks;
    const auto swap = [&](const void* out, int outCount, void* in, int inCount, MPI_Datatype type) {
        MPI_Sendrecv(out, outCount, type, next, 0, in, inCount, type, previous, 0, communicator_, MPI_STATUS_IGNORE);
    };
    const int leaving = static_cast<int>(visitors_.rows());
    int coming = 0;
    swap(&leaving, 1, &coming, 1, MPI_INT);
    nextVisitors_.resize(coming, 3);
    nextVisitorCharge_.resize(coming);
    swap(visitors_.data(), 3 * leaving, nextVisitors_.data(), 3 * coming, MPI_DOUBLE);
    swap(visitorCharge_.data(), leaving, nextVisitorCharge_.data(), coming, MPI_DOUBLE);
    visitors_.swap(nextVisitors_);
    visitorCharge_.swap(nextVisitorCharge_);
}

void PairwiseSum::compute(const DemParticles& particles, ParticleField& result)
{
    int ranks = 1;
    MPI_Comm_size(communicator_, &ranks);
    result.field.setZero(particles.size(), 3);
    result.potential.setZero(particles.size());
    visitors_ = particles.position;
    visitorCharge_ = particles.charge;

    std::int64_t pairs = 0;
    std::string failure;
    Points failedSources;
    for (int turn = 0; turn < ranks; ++turn) {
        if (turn > 0) {
            passOn();
        }
        const PhaseTimer timer(times_, Phase::near);
        try {
            pairs += addAllPairs(particles.position, visitors_, visitorCharge_, turn == 0 ? 0 : -1, settings_.permittivity,
                                 result.field, result.potential, settings_.pairwiseSum.truncation);
            if (settings_.pairwiseSum.images) {
                walls_.make(visitors_, visitorCharge_, images_);
                pairs += addAllPairs(particles.position, images_.position, images_.charge, -1, settings_.permittivity,
                                     result.field, result.potential, settings_.pairwiseSum.truncation);
            }
        } catch (const std::domain_error& error) {
            // Keep the ring going; all ranks stop together below.
            failure = error.what();
            failedSources.resize(particles.size() + (turn == 0 ? 0 : visitors_.rows()), 3);
            failedSources.topRows(particles.size()) = particles.position;
            if (turn > 0) {
                failedSources.bottomRows(visitors_.rows()) = visitors_;
            }
        }
    }
    result.pairs = sumPairs(pairs, failure, particles, failedSources, communicator_);
    result.ownResponse.resize(0, 3);
    if (settings_.pairwiseSum.images && settings_.ownResponse) {
        walls_.ownField(particles, settings_.permittivity, settings_.pairwiseSum.truncation, result.ownResponse);
    }
    addExternalField(settings_.externalField, result);
    addExternalPotential(settings_.externalField, particles, result);
}

void PairwiseSum::fieldOfOthers(const DemParticles& sources, const Points& points, const std::vector<int>& leftOut,
                                Points& field)
{
    ContactPoints all(points, leftOut, communicator_);
    if (all.size() > 0 && settings_.pairwiseSum.images) {
        walls_.make(sources.position, sources.charge, images_);
    }
    const double coulombConstant = 1.0 / (4.0 * pi * settings_.permittivity);
    for (Index n = 0; n < all.size(); ++n) {
        const auto add = [&](Index owner, const Points& places, const Scalars& charges, Index row) {
            const Vector3 r = all.place(n) - places.row(row).matrix().transpose();
            const double distance = r.norm();
            if (sources.tag[static_cast<std::size_t>(owner)] != all.leftOut(n) && distance > 0
                && distance <= settings_.pairwiseSum.truncation) {
                all.add(n, coulombConstant * charges[row] / (distance * distance * distance) * r);
            }
        };
        for (Index row = 0; row < sources.size(); ++row) {
            add(row, sources.position, sources.charge, row);
        }
        for (Index row = 0; settings_.pairwiseSum.images && row < images_.position.rows(); ++row) {
            add(images_.owner[static_cast<std::size_t>(row)], images_.position, images_.charge, row);
        }
    }
    all.sum(field);
    field.rowwise() += settings_.externalField.transpose().array();
}

}  // namespace him
