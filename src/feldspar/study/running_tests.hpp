// Tests that run side by side, each on a thread of its own, with a team of threads as large as it is granted. The main thread
// starts them and hears of them here; it alone decides, prints and writes what only one thread may write.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "feldspar/lab/run_test.hpp"

namespace feldspar {

/// All calls are the main thread's.
class RunningTests {
public:
    /// Runs a test to its end; called on the test's own thread.
    using Work = std::function<TestResult(const RunControl&)>;

    /// What a test has told last.
    struct News {
        std::size_t number;
        TestProgress progress;
    };

    /// A test that is over: with a result, or with what it threw.
    struct Ended {
        std::size_t number;
        std::optional<TestResult> result;
        std::exception_ptr error;
    };

    struct Events {
        std::vector<News> news;     ///< by number
        std::vector<Ended> ended;   ///< by number
    };

    /// @param threads  that the tests have together
    /// @param stop     becomes true when the user interrupts: tests end at their next record
    RunningTests(int threads, std::atomic<bool>& stop);

    /// Asks tests that are still running to stop, and waits for them.
    ~RunningTests();
    RunningTests(const RunningTests&) = delete;
    RunningTests& operator=(const RunningTests&) = delete;

    int count() const;
    int free_threads() const;

    /// @param number   the test's, to know it again; those that start later have larger ones
    /// @param threads  of free_threads()
    /// @param useful   more than so many threads would not make it faster
    void start(std::size_t number, int threads, int useful, Work work);

    /// Gives the free threads to the tests that run.
    void share_out_free_threads();

    /// What has happened since the last call; waits for something if `patient`, but only if a test is running.
    Events events(bool patient);

private:
    struct Test;
    void run(Test& test, const Work& work);

    int threads_;
    std::atomic<bool>& stop_;
    std::vector<std::unique_ptr<Test>> tests_;
    std::mutex mutex_;                  // guards what the tests leave for events()
    std::condition_variable something_;
    bool happened_ = false;
};

}  // namespace feldspar
