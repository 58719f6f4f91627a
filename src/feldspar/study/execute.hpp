// Runs of a study on this machine, side by side.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/output/checkpoints.hpp"
#include "feldspar/study/device_use.hpp"
#include "feldspar/study/ledger.hpp"
#include "feldspar/study/live_runs.hpp"

namespace feldspar {

/// What the caller decides about the running itself; none of it changes a result.
struct ExecuteControl {
    int threads = 1;  ///< of the whole program
    int at_once = 0;  ///< at most so many runs side by side; 0 = as suits their size
    Keep keep = Keep::histories;
    bool retry_failed =
        false;  ///< also runs that failed for good: of their input or numerically, with this version of the program
    std::atomic<bool>* stop = nullptr;  ///< becomes true when the user interrupts
    CheckpointSettings checkpoints;
    DeviceUse device;  ///< where the steps are made
    Provenance provenance;
    std::function<void(const Run&, const TestProgress&)> progress;  ///< a run tells how far it is; may be empty
    std::function<void(const Run&, const RunRecord&)> ended;        ///< done or failed; may be empty
    std::function<void(const std::string&)> note;                   ///< something that the user should read; may be empty
    LiveRuns* live = nullptr;  ///< shows the runs while they are made; may be null. One that the user ends there is recorded as
                               ///< failed, "ended by the user", and made again by the next call
};

/// How many of the runs were found in which state, and what became of the others.
struct Execution {
    int found_done = 0;
    int found_failed = 0;  ///< for good, and not repeated
    int done = 0;
    int failed = 0;
    int left = 0;        ///< not run: interrupted
    double run_s = 0.0;  ///< summed over the runs of this call: packing, test, files
    double wall_s = 0.0;
};

/// Runs what is not done yet, and waits for what another process has claimed. A failed run is recorded with its reason and does
/// not stop the others; one that failed for good is not repeated. @throws OutputError when results cannot be written
Execution execute(std::span<const Run> runs, Ledger& ledger, const ExecuteControl& control);

}  // namespace feldspar
