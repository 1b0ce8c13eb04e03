// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_error.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace him {

namespace {

/// Mixes the bits of a tag, so that a sample by tag has nothing to do with the order in which particles were made.
std::uint32_t scrambled(int tag)
{
    auto bits = static_cast<std::uint32_t>(tag);
    bits = (bits ^ (bits >> 16)) * 0x7feb352dU;
    bits = (bits ^ (bits >> 15)) * 0x846ca68bU;
    return bits ^ (bits >> 16);
}

/// Rows of all ranks, one below the other in the order of ranks; `first` is where this rank's begin. Collective.
Points gathered(const Points& mine, MPI_Comm communicator, Index& first)
{
    int ranks = 1;
    int rank = 0;
    MPI_Comm_size(communicator, &ranks);
    MPI_Comm_rank(communicator, &rank);
    const int count = static_cast<int>(3 * mine.rows());
    std::vector<int> counts(static_cast<std::size_t>(ranks));
    std::vector<int> offsets(static_cast<std::size_t>(ranks), 0);
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (std::size_t r = 1; r < counts.size(); ++r) {
        offsets[r] = offsets[r - 1] + counts[r - 1];
    }
    Eigen::Array3Xd from = mine.transpose();
    Eigen::Array3Xd all(3, (offsets.back() + counts.back()) / 3);
    MPI_Allgatherv(from.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, communicator);
    first = offsets[static_cast<std::size_t>(rank)] / 3;
    return all.transpose();
}

/// The text of the first rank that has one; empty when none has. Collective.
std::string firstText(const std::string& mine, MPI_Comm communicator)
{
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &ranks);
    int first = mine.empty() ? ranks : rank;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, communicator);
    if (first == ranks) {
        return {};
    }
    std::string text = mine;
    int length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, first, communicator);
    text.resize(static_cast<std::size_t>(length));
    MPI_Bcast(text.data(), length, MPI_CHAR, first, communicator);
    return text;
}

}  // namespace

FieldErrorMonitor::FieldErrorMonitor(const FieldErrorSettings& settings, std::unique_ptr<FieldReference> reference,
                                     const Vector3& externalField, MPI_Comm communicator)
    : settings_(settings), reference_(std::move(reference)), externalField_(externalField), communicator_(communicator)
{
    if (settings.sample < 1 || settings.interval < 0) {
        throw std::invalid_argument("FieldErrorMonitor: sample must be >= 1 and interval >= 0");
    }
}

bool FieldErrorMonitor::due(long update, double runSeconds) const
{
    if (!settings_.active || !reference_) {
        return false;
    }
    if (update == 0) {
        return true;
    }
    if (settings_.interval > 0) {
        return update % settings_.interval == 0;
    }
    // The clocks of the ranks differ; the first rank's decides.
    int answer = spent_ + last_ <= shareOfTime * runSeconds ? 1 : 0;
    MPI_Bcast(&answer, 1, MPI_INT, 0, communicator_);
    return answer == 1;
}

std::vector<Index> FieldErrorMonitor::sampleRows(const DemParticles& particles) const
{
    std::int64_t total = particles.size();
    MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_INT64_T, MPI_SUM, communicator_);
    const auto every = static_cast<std::uint32_t>(std::max<std::int64_t>(1, total / settings_.sample));
    std::vector<Index> rows;
    for (Index row = 0; row < particles.size(); ++row) {
        if (scrambled(particles.tag[static_cast<std::size_t>(row)]) % every == 0) {
            rows.push_back(row);
        }
    }
    return rows;
}

FieldError FieldErrorMonitor::measure(const DemParticles& particles, const Points& field)
{
    const auto start = std::chrono::steady_clock::now();
    FieldError error;
    if (!reference_) {
        error.failure = "there is no reference";
        return error;
    }
    const std::vector<Index> rows = sampleRows(particles);
    Index first = 0;
    const Points targets = gathered(particles.position(rows, Eigen::all), communicator_, first);
    Points difference = gathered(field(rows, Eigen::all), communicator_, first);
    std::vector<Index> ownRow(static_cast<std::size_t>(targets.rows()), -1);
    std::copy(rows.begin(), rows.end(), ownRow.begin() + first);

    Points exact = Points::Zero(targets.rows(), 3);
    std::string failure;
    try {
        reference_->addField(particles, targets, ownRow, exact);
    } catch (const std::domain_error& refusal) {
        failure = refusal.what();
    }
    error.failure = firstText(failure, communicator_);
    if (error.failure.empty()) {
        MPI_Allreduce(MPI_IN_PLACE, exact.data(), static_cast<int>(exact.size()), MPI_DOUBLE, MPI_SUM, communicator_);
        difference -= exact;
        difference.rowwise() -= externalField_.transpose().array();
        error.sample = targets.rows();
        error.referenceRms = error.sample > 0 ? std::sqrt(exact.square().rowwise().sum().mean()) : 0;
        if (error.referenceRms > 0) {
            const Scalars squares = difference.square().rowwise().sum();
            error.rms = std::sqrt(squares.mean()) / error.referenceRms;
            error.largest = std::sqrt(squares.maxCoeff()) / error.referenceRms;
        } else {
            error.failure = "no particle of the sample feels a field of charges";
        }
    }
    error.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    MPI_Allreduce(MPI_IN_PLACE, &error.seconds, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    last_ = error.seconds;
    spent_ += error.seconds;
    return error;
}

}  // namespace him
