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
#include "feldspar/study/sharing.hpp"

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
        std::vector<News> news;    ///< by number
        std::vector<Ended> ended;  ///< by number
    };

    /// @param sharing  how many tests go together, and on how many threads each
    /// @param stop     becomes true when the user interrupts: tests end at their next record
    RunningTests(const Sharing& sharing, std::atomic<bool>& stop);

    /// Asks tests that are still running to stop, and waits for them.
    ~RunningTests();
    RunningTests(const RunningTests&) = delete;
    RunningTests& operator=(const RunningTests&) = delete;

    int count() const;

    /// Whether a test of so many bodies may start beside those that run.
    bool has_room_for(int bodies) const;

    /// @param number   the test's, to know it again; those that start later have larger ones
    /// @param bodies   there is room for so many
    /// @param waiting  tests that are not started yet, this one included: they leave threads to each other
    void start(std::size_t number, int bodies, std::size_t waiting, Work work);

    /// Gives the free threads to the tests that run.
    void share_out_free_threads();

    /// What has happened since the last call; waits for something if `patient`, but only if a test is running.
    Events events(bool patient);

private:
    struct Test;
    void run(Test& test, const Work& work);
    int free_threads() const;
    int company_with(int bodies) const;

    Sharing sharing_;
    std::atomic<bool>& stop_;
    int company_ = 1;  // most tests at once that go with those that run
    std::vector<std::unique_ptr<Test>> tests_;
    std::mutex mutex_;  // guards what the tests leave for events()
    std::condition_variable something_;
    bool happened_ = false;
};

}  // namespace feldspar
