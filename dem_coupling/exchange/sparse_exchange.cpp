// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/sparse_exchange.hpp"

#include <stdexcept>

namespace him {

namespace {
constexpr int messageTag = 4711;
}

SparseExchange::SparseExchange(MPI_Comm communicator) : communicator_(communicator)
{
    MPI_Comm_rank(communicator_, &rank_);
    MPI_Comm_size(communicator_, &ranks_);
    sendCounts_.resize(static_cast<std::size_t>(ranks_));
    receiveCounts_.resize(static_cast<std::size_t>(ranks_));
    requests_.reserve(2 * static_cast<std::size_t>(ranks_));
}

void SparseExchange::clear(Buffers& buffers) const
{
    buffers.resize(static_cast<std::size_t>(ranks_));
    for (auto& buffer : buffers) {
        buffer.clear();
    }
}

void SparseExchange::exchange(const Buffers& outgoing, Buffers& incoming)
{
    for (std::size_t r = 0; r < outgoing.size(); ++r) {
        sendCounts_[r] = static_cast<int>(outgoing[r].size());
    }
    MPI_Alltoall(sendCounts_.data(), 1, MPI_INT, receiveCounts_.data(), 1, MPI_INT, communicator_);
    incoming.resize(static_cast<std::size_t>(ranks_));
    for (std::size_t r = 0; r < incoming.size(); ++r) {
        incoming[r].resize(static_cast<std::size_t>(receiveCounts_[r]));
    }
    answer(outgoing, incoming);
}

void SparseExchange::answer(const Buffers& outgoing, Buffers& incoming)
{
    requests_.clear();
    for (int r = 0; r < ranks_; ++r) {
        auto& buffer = incoming[static_cast<std::size_t>(r)];
        if (r != rank_ && !buffer.empty()) {
            requests_.emplace_back();
            MPI_Irecv(buffer.data(), static_cast<int>(buffer.size()), MPI_DOUBLE, r, messageTag, communicator_,
                      &requests_.back());
        }
    }
    for (int r = 0; r < ranks_; ++r) {
        const auto& buffer = outgoing[static_cast<std::size_t>(r)];
        if (r != rank_ && !buffer.empty()) {
            requests_.emplace_back();
            MPI_Isend(buffer.data(), static_cast<int>(buffer.size()), MPI_DOUBLE, r, messageTag, communicator_,
                      &requests_.back());
        }
    }
    const auto own = static_cast<std::size_t>(rank_);
    incoming[own] = outgoing[own];
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
}

void throwTogether(MPI_Comm communicator, int key, const std::string& text)
{
    struct { int key, rank; } mine{key, 0}, first{};
    MPI_Comm_rank(communicator, &mine.rank);
    MPI_Allreduce(&mine, &first, 1, MPI_2INT, MPI_MINLOC, communicator);

    int length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, first.rank, communicator);
    std::string message = text;
    message.resize(static_cast<std::size_t>(length));
    MPI_Bcast(message.data(), length, MPI_CHAR, first.rank, communicator);
    throw std::runtime_error(message);
}

}  // namespace him
