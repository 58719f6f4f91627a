// Progress on stderr: on a terminal one line for each running test, rewritten; elsewhere a plain line every ten seconds.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// "12 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

class Progress {
public:
    Progress();

    /// A line that stays.
    void note(const std::string& line);

    /// What is being done now, for work that does not report by itself.
    void busy(const std::string& what);

    /// A specimen tells how far it is.
    void making(const std::string& what, const SpecimenProgress& progress);

    /// Of many short tests: a log says nothing of one until it has run for ten seconds.
    void keep_log_short() { log_stages_ = false; }

    /// Test `number` of `count` reports; its `label` is "biaxial at 4 MPa, seed 1".
    void report(int number, int count, const std::string& label, const TestProgress& progress);

    /// Test `number` no longer runs: its line goes away.
    void ended(int number);

    /// Takes the rewritten lines away.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    // A test that runs.
    struct Running {
        std::string line;
        std::string stage;
        Clock::time_point last_plain_line;
    };

    void rewrite(const std::vector<std::string>& lines);

    bool terminal_ = false;
    bool log_stages_ = true;
    std::size_t lines_shown_ = 0;
    std::map<int, Running> running_;  // by the test's number
    Clock::time_point last_rewrite_;
    std::string making_;  // the specimen told of last
    Clock::time_point last_making_;
};

}  // namespace feldspar
