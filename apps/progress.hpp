// Progress on stderr: one line that is rewritten on a terminal, a plain line every ten seconds elsewhere.
#pragma once

#include <chrono>
#include <string>

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

    /// The specimen `what` reports while it is made; to be passed on to make_specimen with the number of threads. An interruption by
    /// the user ends the making. @throws Interrupted from the callback
    SpecimenControl making(const std::string& what, int threads);

    /// Test `number` of `count` reports; its `label` is "biaxial at 4 MPa, seed 1".
    void report(int number, int count, const std::string& label, const TestProgress& progress);

    /// Takes the rewritten line away.
    void clear();

private:
    void rewrite(const std::string& line);
    void report_making(const std::string& what, const SpecimenProgress& progress);

    bool terminal_ = false;
    bool line_shown_ = false;
    std::string last_label_;
    std::string last_stage_;
    std::chrono::steady_clock::time_point last_line_;
};

}  // namespace feldspar
