// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <mpi.h>

#include <exception>
#include <string>

namespace him {

/// What `action` throws; fails the test on every rank unless every rank throws the same text. Collective.
template<class Action>
std::string textThrownOnAllRanks(MPI_Comm communicator, Action action)
{
    std::string text;
    try {
        action();
    } catch (const std::exception& error) {
        text = error.what();
    }
    EXPECT_FALSE(text.empty()) << "nothing was thrown on this rank";
    int length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, communicator);
    std::string first = text;
    first.resize(static_cast<std::size_t>(length));
    MPI_Bcast(first.data(), length, MPI_CHAR, 0, communicator);
    EXPECT_EQ(text, first) << "another text than on rank 0";
    return text;
}

inline void expectContains(const std::string& text, const std::string& part)
{
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

}  // namespace him
