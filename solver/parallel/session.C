// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/session.H"

#include "Pstream.H"
#include "stringList.H"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

namespace him {

namespace {

std::string programName;

/// The complaints of all ranks, without repetitions, in the order of the ranks; complete on rank 0.
Complaints gathered(const Complaints& own)
{
    Foam::List<Foam::stringList> byRank(Foam::Pstream::nProcs());
    for (const std::string& line : own.lines()) {
        byRank[Foam::Pstream::myProcNo()].append(line);
    }
    Foam::Pstream::gatherList(byRank);

    std::vector<std::string> lines;
    for (const Foam::stringList& part : byRank) {
        for (const Foam::string& line : part) {
            if (std::find(lines.begin(), lines.end(), line) == lines.end()) {
                lines.push_back(line);
            }
        }
    }
    Complaints unique;
    for (const std::string& line : lines) {
        const std::size_t colon = line.find(": ");
        unique.add(line.substr(0, colon), line.substr(colon + 2));
    }
    return unique;
}

/// Whether all ranks get here within a few seconds.
bool allRanksArrive(MPI_Comm communicator)
{
    MPI_Request request;
    MPI_Ibarrier(communicator, &request);
    for (int tenths = 0; tenths < 50; ++tenths) {
        int done = 0;
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
}

}  // namespace

MPI_Comm openSession(const std::string& program)
{
    programName = program;
    if (Foam::Pstream::parRun()) {
        return MPI_COMM_WORLD;
    }
    Foam::Pstream::initNull();
    return MPI_COMM_SELF;
}

int runSession(int argc, char* argv[], const std::function<void(const Foam::argList&, MPI_Comm)>& run)
{
    Foam::argList args(argc, argv);
    if (!args.checkRootCase()) {
        Foam::FatalError.exit();
    }
    const MPI_Comm communicator = openSession(args.executable());
    try {
        run(args, communicator);
    } catch (const std::exception& failure) {
        stopOnFailure(failure.what(), communicator);
    }
    return 0;
}

void leave(int exitCode)
{
    std::cout.flush();
    std::cerr.flush();
    MPI_Finalize();
    std::exit(exitCode);
}

void stopOnComplaints(const Complaints& complaints, const std::string& stage, MPI_Comm communicator)
{
    int found = complaints.none() ? 0 : 1;
    MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, communicator);
    if (!found) {
        return;
    }
    const Complaints all = gathered(complaints);
    if (Foam::Pstream::master()) {
        std::cout << "\n" << programName << " cannot run this case. " << stage << ":\n" << all.text() << std::endl;
    }
    leave(1);
}

void stopOnFailure(const std::string& message, MPI_Comm communicator)
{
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    const bool together = allRanksArrive(communicator);
    if (rank == 0 || !together) {
        std::cout << "\n" << programName << " stops: " << message << std::endl;
    }
    if (!together) {
        MPI_Abort(communicator, 1);
    }
    leave(1);
}

}  // namespace him
