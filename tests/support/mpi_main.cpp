// SPDX-License-Identifier: GPL-3.0-or-later
// main() of tests that run on several ranks. A failure on any rank fails the test on all of them, and every rank says
// its own failures.
#include <gtest/gtest.h>
#include <mpi.h>

#include <iostream>
#include <sstream>
#include <string>

namespace {

/// Prints failures of ranks other than 0, whose usual output is switched off, in one piece.
class FailuresOfRank : public testing::EmptyTestEventListener {
public:
    explicit FailuresOfRank(int rank) : rank_(rank) {}

    // The name is kept here: GoogleTest holds its lock when it reports a part, so asking it then would wait for ever.
    void OnTestStart(const testing::TestInfo& test) override
    {
        test_ = std::string(test.test_suite_name()) + '.' + test.name();
    }

    void OnTestPartResult(const testing::TestPartResult& part) override
    {
        if (part.failed()) {
            std::ostringstream text;
            text << "rank " << rank_ << ": " << test_ << " failed at " << (part.file_name() ? part.file_name() : "?") << ':'
                 << part.line_number() << '\n'
                 << part.message() << '\n';
            std::cerr << text.str() << std::flush;
        }
    }

private:
    int rank_;
    std::string test_;
};

}  // namespace

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    testing::InitGoogleTest(&argc, argv);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    if (rank > 0) {
        delete listeners.Release(listeners.default_result_printer());
        listeners.Append(new FailuresOfRank(rank));
    }
    int failed = RUN_ALL_TESTS();
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (failed != 0 && rank == 0) {
        std::cerr << "a test failed on at least one rank\n";
    }
    MPI_Finalize();
    return failed;
}
