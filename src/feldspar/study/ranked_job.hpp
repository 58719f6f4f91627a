// A job whose tests several ranks make together (ranks/): the first one leads, reads, writes and prints; the others follow it
// from test to test.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "feldspar/job/job.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/ranks/communicator.hpp"

namespace feldspar {

/// The job, read by every rank. @throws InputError on all of them alike: what one of them has found wrong, or that they do not
/// have the same job, version of the program and vector instructions
Job read_together(Communicator& ranks, const std::function<Job()>& read, const Provenance& provenance);

/// One test, which all ranks make together: all call this with the same setup, and have the same result. Of the control the first
/// rank's keeper and stop count.
TestResult run_ranked(Communicator& ranks, const TestSetup& setup, RunControl control);

/// Leads the others: once in a job, on the first rank.
class JobLeader {
public:
    explicit JobLeader(Communicator& ranks) : ranks_(ranks) {}
    JobLeader(const JobLeader&) = delete;
    JobLeader& operator=(const JobLeader&) = delete;
    /// The job is over for all.
    ~JobLeader();

    /// Makes the test with the others. @param run  its number in the job; one at a time
    TestResult run(std::size_t run, const TestSetup& setup, RunControl control);

private:
    Communicator& ranks_;
};

/// Makes the tests that the first rank orders, until the job is over, and keeps nothing of them. @throws what ends this rank
/// alone: RankLost, too little memory
void follow_job(const Job& job, Communicator& ranks, int threads, const std::atomic<bool>& stop);

}  // namespace feldspar
