// The runs of a study, run and told of: what the commands study, envelope and converge share.
#pragma once

#include <string>

#include "feldspar/base/error.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/ledger.hpp"

namespace feldspar {

struct StudyRunning {
    int threads = 1;             ///< of the whole program
    int at_once = 0;             ///< runs side by side; 0 = as suits their size
    std::string command_line;    ///< for provenance
    std::string device = "cpu";  ///< where the steps are made
    bool retry_failed = false;   ///< also runs that failed for good
};

/// "biaxial at 4 MPa, seed 1".
std::string label_of(const Run& run);

/// "rigid, 2: biaxial at 4 MPa, seed 1".
std::string label_of(const Study& study, const Run& run);

/// "114 MPa, grade B, 4.1 s", or why it failed.
std::string result_text(const RunRecord& record);

/// Enrols the study, runs what is not done yet, and tells of it on stderr.
Execution run_study(const Study& study, Ledger& ledger, const StudyRunning& running);

/// Counts and times, where the ledger is, and what to do about an interruption.
void print_execution(const Study& study, const Execution& execution);

/// Interrupted if runs are left, numerical if one failed, now or before.
ExitCode outcome(const Execution& execution);

}  // namespace feldspar
