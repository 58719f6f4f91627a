// A study on a Slurm cluster: what is not done goes there as a job array, and comes back as run.json files. Elements never touch
// the ledger, which may lie on a network file system; one job behind the array takes their records in.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "feldspar/study/execute.hpp"
#include "feldspar/study/ledger.hpp"
#include "feldspar/study/slurm_plan.hpp"

namespace feldspar {

/// @throws InputError if Slurm's programs are not on the PATH
void require_slurm();

/// What became of the runs of a study that was to be submitted.
struct Submission {
    int done = 0;       ///< were done before
    int failed = 0;     ///< failed for good before, and are not repeated
    int queued = 0;     ///< are in Slurm's queue already
    int elsewhere = 0;  ///< a live process of this machine is at them
    int submitted = 0;
    double expected_s = 0.0;        ///< of those, summed, on one thread
    std::optional<SlurmPlan> plan;  ///< none if nothing was to be submitted
};

/// Takes in what earlier elements have left, and submits what is neither done nor on its way, nor failed for good unless
/// `retry_failed`.
/// @throws InputError when Slurm is not there or refuses, with its own words
Submission submit(const Study& study, Ledger& ledger, const SlurmOptions& options, const std::filesystem::path& program,
                  bool retry_failed = false);

/// Runs what an array's element is for and is not done yet. Writes nothing but the runs' directories; a failed run leaves its
/// reason in run.json. May be repeated (requeued), and ends cleanly when asked to stop. `control.keep` is the plan's.
Execution run_element(const SlurmPlan& plan, std::size_t element, ExecuteControl control);

/// Runs without a record whose element is no longer in the queue.
struct LostElement {
    std::string job;                ///< "12_3"
    std::filesystem::path output;   ///< what it has printed
    std::vector<std::string> runs;  ///< their ids
    std::string reason;             ///< from Slurm's records, in words
};

/// What gather() found.
struct Gathering {
    int taken = 0;                  ///< runs that are done, and were not in the ledger yet
    int queued = 0;                 ///< runs that are not done, and whose element waits or runs
    std::vector<RunRecord> failed;  ///< runs that ended without a result
    std::vector<LostElement> lost;

    /// Runs of lost elements.
    std::size_t missing() const {
        std::size_t count = 0;
        for (const LostElement& element : lost) count += element.runs.size();
        return count;
    }
};

/// Reads the run.json files of all plans of this ledger's directory into it. May be repeated at any time. @throws InputError when
/// Slurm does not say what is in its queue
Gathering gather(Ledger& ledger);

/// How far an array is.
struct ArrayState {
    int waiting = 0, running = 0;  ///< elements
    int recorded = 0, runs = 0;    ///< runs with a record, of all
    bool over = false;             ///< neither an element nor the gathering job is in the queue any more
};

/// One for each of the plans. @throws InputError when Slurm cannot be asked
std::vector<ArrayState> array_states(std::span<const SlurmPlan> plans);

/// Elements of job arrays in text as Slurm writes it: "3", "4-6,9%2". @return nothing for other texts
std::vector<std::size_t> elements_in(const std::string& text);

}  // namespace feldspar
