// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

namespace him {

/// Point-to-point exchange of doubles between the ranks that have something for each other. One number per pair of
/// ranks (the counts) is exchanged collectively, the data only where a count is not zero.
class SparseExchange {
public:
    /// One buffer per rank. Buffers keep their memory between calls, so a steady run allocates nothing.
    using Buffers = std::vector<std::vector<double>>;

    explicit SparseExchange(MPI_Comm communicator);

    int rank() const { return rank_; }
    int ranks() const { return ranks_; }
    MPI_Comm communicator() const { return communicator_; }

    /// Empties `buffers` and gives it one buffer per rank.
    void clear(Buffers& buffers) const;

    /// outgoing[r] goes to rank r; incoming[r] becomes what rank r sent here. Collective.
    void exchange(const Buffers& outgoing, Buffers& incoming);

    /// The same when this rank knows already how much comes: incoming[r] must have the size of what rank r sends.
    /// No collective call; for answers to an exchange().
    void answer(const Buffers& outgoing, Buffers& incoming);

private:
    MPI_Comm communicator_;
    int rank_ = 0;
    int ranks_ = 1;
    std::vector<int> sendCounts_, receiveCounts_;
    std::vector<MPI_Request> requests_;
};

/// Throws the same std::runtime_error on every rank: the text of the rank with the smallest key. Ranks with nothing to
/// say pass nothingToSay. Call it on all ranks, once they know that one of them has found a fault. Collective.
constexpr int nothingToSay = 2147483647;
[[noreturn]] void throwTogether(MPI_Comm communicator, int key, const std::string& text);

}  // namespace him
