// The schedule with runs that do nothing, or wait for each other: who starts when, who is told what, and how all ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/study/schedule.hpp"

namespace feldspar {
namespace {

constexpr int small = 100, large = 30000;  // bodies: many small tests go together, a large one runs alone

/// A result that says whose it is.
TestResult result_of(std::size_t run) {
    TestResult result;
    result.seed = run;
    return result;
}

/// Waits, but not for ever.
bool comes_true(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return condition();
}

/// Writes down what happens. What a run does may be told; by default it ends at once.
class FakeSink : public RunSink {
public:
    int bodies(std::size_t run) override { return bodies_of.contains(run) ? bodies_of[run] : small; }
    RunningTests::Work begin(std::size_t run) override {
        note("begin", run);
        if (std::erase(nothing_to_do, run) > 0) return {};
        if (std::erase(later, run) > 0) {
            put_off.push_back(run);
            return {};
        }
        ++begun;
        if (const auto own = work.find(run); own != work.end()) return own->second;
        return [run](const RunControl&) { return result_of(run); };
    }
    void progress(std::size_t run, const TestProgress& state) override {
        if (on_progress) on_progress(run, state);
    }
    void ended(std::size_t run) override { note("ended", run); }
    void finished(std::size_t run, TestResult result) override {
        EXPECT_EQ(result.seed, run);
        note(result.interrupted ? "interrupted" : "finished", run);
        if (on_finished) on_finished(run);
    }
    void failed(std::size_t run, const std::exception_ptr& error) override {
        try {
            std::rethrow_exception(error);
        } catch (const std::exception& problem) {
            note(std::string("failed of ") + problem.what(), run);
        }
        if (throws_on_failure) std::rethrow_exception(error);
    }
    std::vector<std::size_t> another_turn() override { return std::exchange(put_off, {}); }
    void beat() override { ++beats; }

    /// The numbers of what happened so, in its order.
    std::vector<std::size_t> who(const std::string& what) const {
        std::vector<std::size_t> runs;
        for (const auto& [happened, run] : log)
            if (happened == what) runs.push_back(run);
        return runs;
    }
    /// The numbers of those that were finished or failed.
    std::vector<std::size_t> taken() const {
        std::vector<std::size_t> runs;
        for (const auto& [happened, run] : log)
            if (happened != "begin" && happened != "ended") runs.push_back(run);
        return runs;
    }
    /// Its place in the log.
    std::size_t place(const std::string& what, std::size_t run) const {
        return static_cast<std::size_t>(std::find(log.begin(), log.end(), std::pair(what, run)) - log.begin());
    }

    std::map<std::size_t, int> bodies_of;
    std::map<std::size_t, RunningTests::Work> work;
    std::vector<std::size_t> nothing_to_do, later;
    std::function<void(std::size_t)> on_finished;
    std::function<void(std::size_t, const TestProgress&)> on_progress;
    bool throws_on_failure = false;
    std::atomic<int> begun{0};
    int beats = 0;

private:
    void note(const std::string& what, std::size_t run) { log.emplace_back(what, run); }
    std::vector<std::pair<std::string, std::size_t>> log;
    std::vector<std::size_t> put_off;
};

using Numbers = std::vector<std::size_t>;

class ScheduleOfRuns : public ::testing::Test {
protected:
    std::size_t run(std::size_t count, int threads, int at_once = 0) {
        return run_in_order(count, Sharing(at_once, threads), stop_, sink_);
    }

    /// A run that ends when it is asked to stop.
    RunningTests::Work until_stopped(std::size_t number) {
        return [this, number](const RunControl& control) {
            EXPECT_TRUE(comes_true([&] { return control.stop->load(); }));
            ++stopped_;
            TestResult result = result_of(number);
            result.interrupted = true;
            return result;
        };
    }

    std::atomic<bool> stop_{false};
    std::atomic<int> stopped_{0};
    FakeSink sink_;
};

TEST_F(ScheduleOfRuns, EveryRunStartsInOrderAndIsFinishedOnce) {
    const Numbers all{0, 1, 2, 3, 4, 5, 6};
    for (const int threads : {1, 3}) {
        SCOPED_TRACE(threads);
        FakeSink sink;
        EXPECT_EQ(run_in_order(all.size(), Sharing(0, threads), stop_, sink), 0u);
        EXPECT_EQ(sink.who("begin"), all);
        EXPECT_EQ(sink.who("ended"), sink.who("finished"));
        Numbers finished = sink.who("finished");
        if (threads > 1) std::sort(finished.begin(), finished.end());
        EXPECT_EQ(finished, all);
        EXPECT_GT(sink.beats, 0);
    }
    EXPECT_EQ(run(0, 2), 0u);
}

TEST_F(ScheduleOfRuns, AResultIsTakenWhenTheNextRunHasBegun) {
    EXPECT_EQ(run(3, 1), 0u);
    EXPECT_LT(sink_.place("begin", 1), sink_.place("finished", 0));
    EXPECT_LT(sink_.place("begin", 2), sink_.place("finished", 1));
    EXPECT_LT(sink_.place("finished", 0), sink_.place("begin", 2));  // but before the one after that
}

TEST_F(ScheduleOfRuns, AFailureIsToldAndTheOthersGoOn) {
    sink_.work[1] = [](const RunControl&) -> TestResult { throw NumericalError("a force is not a number"); };
    EXPECT_EQ(run(4, 2), 0u);
    EXPECT_EQ(sink_.who("failed of a force is not a number"), (Numbers{1}));
    Numbers finished = sink_.who("finished");
    std::sort(finished.begin(), finished.end());
    EXPECT_EQ(finished, (Numbers{0, 2, 3}));
    EXPECT_EQ(sink_.who("ended").size(), 4u);
    EXPECT_FALSE(stop_);
}

TEST_F(ScheduleOfRuns, ResultsAndFailuresComeInTheOrderInWhichRunsEnd) {
    for (std::size_t i = 0; i < 30; i += 3)
        sink_.work[i] = [](const RunControl&) -> TestResult { throw NumericalError("a force is not a number"); };
    EXPECT_EQ(run(30, 3), 0u);
    EXPECT_EQ(sink_.who("ended"), sink_.taken());
    EXPECT_EQ(sink_.taken().size(), 30u);
}

TEST_F(ScheduleOfRuns, AnInterruptionEndsWhatRunsAndStartsNothing) {
    for (std::size_t i = 0; i < 5; ++i) sink_.work[i] = until_stopped(i);
    std::jthread user([this] {
        EXPECT_TRUE(comes_true([this] { return sink_.begun == 2; }));
        stop_ = true;
    });
    EXPECT_EQ(run(5, 2, 2), 3u);
    EXPECT_EQ(sink_.who("begin"), (Numbers{0, 1}));
    EXPECT_EQ(sink_.who("interrupted").size(), 2u);
}

TEST_F(ScheduleOfRuns, NothingStartsWhenItIsStoppedAlready) {
    stop_ = true;
    EXPECT_EQ(run(3, 2), 3u);
    EXPECT_TRUE(sink_.who("begin").empty());
}

TEST_F(ScheduleOfRuns, ASinkThatStopsAtAResultGetsWhatHadBegun) {
    sink_.work[1] = until_stopped(1);
    sink_.on_finished = [this](std::size_t) { stop_ = true; };
    EXPECT_EQ(run(4, 1), 2u);
    EXPECT_EQ(sink_.who("finished"), (Numbers{0}));
    EXPECT_EQ(sink_.who("interrupted"), (Numbers{1}));
}

TEST_F(ScheduleOfRuns, WhatTheSinkThrowsComesOutWhenAllHaveEnded) {
    sink_.work[0] = until_stopped(0);
    sink_.work[1] = [this](const RunControl&) -> TestResult {
        EXPECT_TRUE(comes_true([this] { return sink_.begun == 2; }));
        throw OutputError("the disk is full");
    };
    sink_.throws_on_failure = true;
    EXPECT_THROW(run(4, 2, 2), OutputError);
    EXPECT_TRUE(stop_);
    EXPECT_EQ(stopped_, 1);
    EXPECT_EQ(sink_.who("begin"), (Numbers{0, 1}));
}

TEST_F(ScheduleOfRuns, ARunWithNothingToDoIsPassedOver) {
    sink_.nothing_to_do = {0, 2};
    EXPECT_EQ(run(4, 1), 0u);
    EXPECT_EQ(sink_.who("begin"), (Numbers{0, 1, 2, 3}));
    EXPECT_EQ(sink_.who("finished"), (Numbers{1, 3}));
}

TEST_F(ScheduleOfRuns, ARunThatIsPutOffHasAnotherTurnAtTheEnd) {
    sink_.later = {0, 1};
    EXPECT_EQ(run(3, 1), 0u);
    EXPECT_EQ(sink_.who("begin"), (Numbers{0, 1, 2, 0, 1}));
    EXPECT_EQ(sink_.who("finished"), (Numbers{2, 0, 1}));
}

TEST_F(ScheduleOfRuns, ThreadsAreSharedOutAndFreeOnesHandedOn) {
    std::atomic<int> first{0}, second{0};
    sink_.bodies_of = {{0, 5000}, {1, 5000}};
    sink_.work[0] = [&](const RunControl& control) {
        first = control.threads;
        EXPECT_TRUE(comes_true([&] { return second > 0; }));
        return result_of(0);
    };
    sink_.work[1] = [&](const RunControl& control) {
        second = control.threads;
        EXPECT_TRUE(comes_true([&] { return *control.more_threads == 4; }));  // when the other has ended
        return result_of(1);
    };
    EXPECT_EQ(run(2, 4), 0u);
    EXPECT_EQ(first, 2);
    EXPECT_EQ(second, 2);
}

TEST_F(ScheduleOfRuns, NoMoreThanAreWantedRunAtOnceAndALargeOneRunsAlone) {
    std::atomic<int> running{0}, most{0};
    bool large_was_alone = true;
    for (std::size_t i = 0; i < 8; ++i)
        sink_.work[i] = [&, i](const RunControl& control) {
            const int now = ++running;
            int before = most;
            while (before < now && !most.compare_exchange_weak(before, now)) {
            }
            if (i == 4) large_was_alone = now == 1 && control.threads == 3;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            if (i == 4) large_was_alone = large_was_alone && running == 1;
            --running;
            return result_of(i);
        };
    EXPECT_EQ(run(8, 3, 2), 0u);
    EXPECT_LE(most, 2);
    most = 0;
    sink_.bodies_of[4] = large;
    EXPECT_EQ(run(8, 3), 0u);
    EXPECT_LE(most, 3);
    EXPECT_TRUE(large_was_alone);
}

TEST_F(ScheduleOfRuns, ProgressIsToldOfTheRunThatMakesIt) {
    std::atomic<bool> told{false};
    sink_.on_progress = [&](std::size_t run, const TestProgress& state) {
        EXPECT_EQ(run, 1u);
        EXPECT_EQ(state.step, 42);
        told = true;
    };
    sink_.work[1] = [&](const RunControl& control) {
        TestProgress state;
        state.step = 42;
        control.progress(state);
        EXPECT_TRUE(comes_true([&] { return told.load(); }));
        return result_of(1);
    };
    EXPECT_EQ(run(3, 2), 0u);
    EXPECT_TRUE(told);
}

}  // namespace
}  // namespace feldspar
