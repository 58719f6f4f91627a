// The order in which runs start, end and are taken up: one for the tests of a job and the runs of a study. What a run is, and
// what becomes of its result, a sink says.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/study/running_tests.hpp"
#include "feldspar/study/sharing.hpp"

namespace feldspar {

/// Knows the runs by their numbers and takes what they leave. All calls are made on the thread of run_in_order(). What a call
/// throws ends the schedule at once.
class RunSink {
public:
    virtual ~RunSink() = default;

    /// Bodies of the run that move by themselves: they decide how many runs go together, and on how many threads each.
    virtual int bodies(std::size_t run) = 0;

    /// It is the run's turn. @return what it does on a thread of its own; nothing if there is nothing to do, or not now
    virtual RunningTests::Work begin(std::size_t run) = 0;

    /// A running run tells how far it is.
    virtual void progress(std::size_t run, const TestProgress& state) = 0;

    /// The run no longer runs; what it left comes in finished() or failed().
    virtual void ended(std::size_t run) = 0;

    /// Its result, which may be that of an interrupted test. Runs are taken up in the order in which they ended, and only when
    /// every thread has something to do: so this may take its time.
    virtual void finished(std::size_t run, TestResult result) = 0;

    /// What it threw, Interrupted too, in the same order; an OutputError at once.
    virtual void failed(std::size_t run, const std::exception_ptr& error) = 0;

    /// Nothing runs, and none is left that had no turn yet. @return runs that have another turn, by number; may wait for them
    virtual std::vector<std::size_t> another_turn() { return {}; }

    /// Called again and again while something runs.
    virtual void beat() {}
};

/// Gives the runs 0 ... count - 1 their turns in this order, side by side as `sharing` allows, until all have ended or `stop` is
/// true: then none begins any more, and those that run end at their next record. If the sink throws, `stop` is set, and what runs
/// is waited for.
/// @return how many had no turn
std::size_t run_in_order(std::size_t count, const Sharing& sharing, std::atomic<bool>& stop, RunSink& sink);

}  // namespace feldspar
