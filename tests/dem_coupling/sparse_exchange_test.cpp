// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/exchange/sparse_exchange.hpp"
#include "tests/support/collective_throw.hpp"

#include <gtest/gtest.h>

namespace him {
namespace {

/// How many numbers `from` sends to `to` in these tests: none in many cases.
std::size_t amount(int from, int to, int round) { return static_cast<std::size_t>((3 * from + 5 * to + round) % 4); }

double number(int from, int to, std::size_t n) { return 1000.0 * from + 100.0 * to + static_cast<double>(n); }

SparseExchange::Buffers outgoingOf(const SparseExchange& exchange, int round)
{
    SparseExchange::Buffers outgoing;
    exchange.clear(outgoing);
    for (int to = 0; to < exchange.ranks(); ++to) {
        for (std::size_t n = 0; n < amount(exchange.rank(), to, round); ++n) {
            outgoing[static_cast<std::size_t>(to)].push_back(number(exchange.rank(), to, n));
        }
    }
    return outgoing;
}

TEST(SparseExchange, bringsToEveryRankWhatEveryOtherRankHasForIt)
{
    SparseExchange exchange(MPI_COMM_WORLD);
    SparseExchange::Buffers incoming;
    for (int round = 0; round < 4; ++round) {  // buffers are used again with other sizes
        exchange.exchange(outgoingOf(exchange, round), incoming);
        ASSERT_EQ(incoming.size(), static_cast<std::size_t>(exchange.ranks()));
        for (int from = 0; from < exchange.ranks(); ++from) {
            const auto& buffer = incoming[static_cast<std::size_t>(from)];
            ASSERT_EQ(buffer.size(), amount(from, exchange.rank(), round)) << "from " << from;
            for (std::size_t n = 0; n < buffer.size(); ++n) {
                EXPECT_EQ(buffer[n], number(from, exchange.rank(), n));
            }
        }
    }
}

TEST(SparseExchange, answersReturnToTheRankThatAsked)
{
    SparseExchange exchange(MPI_COMM_WORLD);
    const SparseExchange::Buffers asked = outgoingOf(exchange, 1);
    SparseExchange::Buffers questions, answers;
    exchange.exchange(asked, questions);
    for (auto& buffer : questions) {
        for (double& value : buffer) {
            value = -2 * value;
        }
    }
    answers = asked;
    exchange.answer(questions, answers);
    for (std::size_t r = 0; r < asked.size(); ++r) {
        ASSERT_EQ(answers[r].size(), asked[r].size());
        for (std::size_t n = 0; n < asked[r].size(); ++n) {
            EXPECT_EQ(answers[r][n], -2 * asked[r][n]);
        }
    }
}

TEST(ThrowTogether, throwsTheTextOfTheSmallestKeyOnEveryRank)
{
    const SparseExchange ranks(MPI_COMM_WORLD);
    const int last = ranks.ranks() - 1;
    const bool mine = ranks.rank() == last;
    const std::string text = textThrownOnAllRanks(MPI_COMM_WORLD, [&] {
        throwTogether(MPI_COMM_WORLD, mine ? 7 : nothingToSay, mine ? "particle 7 is wrong" : "");
    });
    EXPECT_EQ(text, "particle 7 is wrong");
}

}  // namespace
}  // namespace him
