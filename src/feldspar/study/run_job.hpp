// A job's tests on this machine, side by side, into a directory of results.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/live/live_board.hpp"
#include "feldspar/output/checkpoints.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/study/device_use.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

class Communicator;

/// Whom a job tells how far it is. All calls are made on the thread of run_job().
class JobListener {
public:
    virtual ~JobListener() = default;

    /// What is being done now, for work that does not report by itself.
    virtual void busy(const std::string& what) = 0;
    /// The packing with this stem of a file name is made.
    virtual void making(const std::string& packing, const SpecimenProgress& progress) = 0;
    /// Something that the user should read.
    virtual void note(const std::string& line) = 0;
    /// The same of something that went wrong, or may have been meant otherwise.
    virtual void warn(const std::string& line) { note(line); }
    /// Test `number` of `count` (from 1 on) runs; its label is "biaxial at 4 MPa, seed 1".
    virtual void progress(int number, int count, const std::string& label, const TestProgress& state) = 0;
    /// Test `number` no longer runs.
    virtual void ended(int number) = 0;
    /// Its result is there and is being written; `label` is "2/6 biaxial at 4 MPa, seed 1".
    virtual void finished(const std::string& label, const TestResult& result) = 0;
    /// What is shown of work that goes on holds no longer.
    virtual void clear() = 0;
    /// An error ends all; the directory has the files of so many tests.
    virtual void broken_off(std::size_t tests, const std::filesystem::path& directory) = 0;
};

/// What the caller decides about the running itself; none of it changes a result.
struct JobControl {
    int threads = 1;  ///< of the whole program
    std::optional<std::string>
        out;  ///< the directory, which must not exist, or have an unfinished run of the same job; else results/<job name>-<n>
    bool fresh = false;  ///< a new directory, even if there is an unfinished run of the same job
    bool go_on = false;  ///< only an unfinished run of the same job is gone on with; InputError if there is none
    Keep keep =
        Keep::all;  ///< numbers: summary, report and jobs; histories: also histories and events; all: also packings and archives
    CheckpointSettings checkpoints;
    DeviceUse device;               ///< where the steps are made
    Communicator* ranks = nullptr;  ///< of several that make the tests together, one after the other: this is the first, and the
                                    ///< others follow it (study/ranked_job.hpp); null: alone
    Provenance provenance;
    std::atomic<bool>* stop = nullptr;  ///< becomes true when the user interrupts, or when nothing more can be written
    JobListener* listener = nullptr;
    LiveBoard* live = nullptr;  ///< shows the run while it goes on; may be null
};

/// What came out of a job.
struct JobOutcome {
    std::filesystem::path directory;
    std::size_t tests = 0;  ///< of the job
    std::vector<TestResult>
        results;  ///< in the job's order, whatever the order in which they ended; also of tests that were interrupted
    PropertySummary properties;      ///< of these; empty if the job has variants, since each has its own
    std::vector<FailedTest> failed;  ///< in the job's order
    bool interrupted = false;
};

/// Goes on with a run of the same job that was ended before it was complete, if there is one where its results are to go:
/// finished tests are taken from there, and those that were under way go on from their last kept state, with the same bits. Makes
/// every packing and judges every setting, so that a mistake shows before there is a directory; then runs all tests and writes
/// each one's files as soon as it has ended. A test that fails is noted, and the others go on. @throws InputError; OutputError
/// when results cannot be written; Interrupted before there was a directory
JobOutcome run_job(const Job& job, const JobControl& control);

}  // namespace feldspar
