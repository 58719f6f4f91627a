// The runs of a study, run and told of: what the commands study, envelope and converge share.
#pragma once

#include <string>

#include "feldspar/base/error.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/ledger.hpp"
#include "live_view.hpp"
#include "printing.hpp"

namespace feldspar {

struct StudyRunning {
    int threads = 1;             ///< of the whole program
    int at_once = 0;             ///< runs side by side; 0 = as suits their size
    std::string command_line;    ///< for provenance
    std::string device = "cpu";  ///< where the steps are made
    bool retry_failed = false;   ///< also runs that failed for good
    bool shows_points = false;   ///< a live view has the page of the study below it, with its points so far
};

/// "biaxial at 4 MPa, seed 1".
std::string label_of(const Run& run);

/// "rigid, 2: biaxial at 4 MPa, seed 1".
std::string label_of(const Study& study, const Run& run);

/// "114 MPa, grade B, 4.1 s", or why it failed.
std::string result_text(const RunRecord& record);

/// Enrols the study, runs what is not done yet, and tells of it on stderr: if it is to be quiet, of failures alone.
/// @param live  shows the runs, if the user wants to see them
Execution run_study(const Study& study, Ledger& ledger, const StudyRunning& running, const Printing& print, LiveView& live);

/// What the page of a live view calls a study, an envelope, a convergence or a calibration, and its runs.
LiveWords words_of(const std::string& whole);

/// All is over: open pages of the live view become the page that was written.
void end_live(LiveView& live, const std::string& whole, const Execution& execution, const std::filesystem::path& page);

/// Counts and times, where the ledger is, and what to do about an interruption.
void print_execution(const Study& study, const Execution& execution, const Printing& print);

/// The same for programs: `directory`, `page`, `ledger`, `interrupted`, and under `executed` how many runs were
/// done now, done before, failed, failed before, left.
Json execution_json(const Study& study, const Execution& execution, const std::filesystem::path& page);

/// Interrupted if runs are left, numerical if one failed, now or before.
ExitCode outcome(const Execution& execution);

}  // namespace feldspar
