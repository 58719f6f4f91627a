#include "feldspar/study/run_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <new>
#include <set>
#include <string_view>
#include <utility>

#include "feldspar/base/counted.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/base/lacking_memory.hpp"
#include "feldspar/base/parallel.hpp"
#include "feldspar/lab/on_device.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/write_cells.hpp"
#include "feldspar/study/job_place.hpp"
#include "feldspar/study/notes.hpp"
#include "feldspar/study/packings.hpp"
#include "feldspar/study/ranked_job.hpp"
#include "feldspar/study/schedule.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kBytesOfAGrain = 400.0;  // at each snapshot of an archive

// Bytes that the job will leave, roughly: fields at the snapshots, histories and the report.
double expected_bytes(const std::vector<PlannedRun>& runs, Keep keep) {
    double bytes = 1e6;
    for (const PlannedRun& run : runs)
        bytes += 1e6 + (keep == Keep::all ? kBytesOfAGrain * grain_count(specimen_of(run)) * (run.test->snapshots + 4) : 0.0);
    return bytes;
}

void check_space(const std::optional<std::string>& out, const std::vector<PlannedRun>& runs, Keep keep) {
    std::error_code error;
    fs::path place = fs::absolute(out ? fs::path(*out) : fs::path("results"), error);
    while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
    const fs::space_info space = fs::space(place, error);
    if (error || space.capacity == 0) return;  // a file system that does not tell is not full
    const double wanted = expected_bytes(runs, keep);
    if (static_cast<double>(space.available) < wanted)
        throw InputError({{}, 0, 0, "--out"},
                         fmt::format("the results need about {:.0f} MB, but the disk of '{}' has only {:.0f} MB free",
                                     wanted / 1e6, place.string(), static_cast<double>(space.available) / 1e6),
                         "a directory on a disk with more space, fewer snapshots, or --keep histories");
}

// The runs of a job with their packings, all of which stay until the job is over.
class PreparedRuns {
public:
    PreparedRuns(const Job& job, const JobControl& control)
        : job_(job),
          control_(control),
          tell_(*control.listener),
          runs_(planned_runs(job)),
          packings_(runs_.size(), control.stop) {}

    const std::vector<PlannedRun>& all() const { return runs_; }
    const PlannedRun& operator[](std::size_t i) const { return runs_[i]; }
    std::size_t count() const { return runs_.size(); }

    std::shared_ptr<const Specimen> specimen(const PlannedRun& run) { return packings_.get(specimen_of(run), run.seed, 1); }
    int bodies(std::size_t i) { return body_count(runs_[i], *specimen(runs_[i])); }

    void prepare() {
        if (*control_.stop) throw Interrupted();
        make_packings();
        side_by_side(static_cast<int>(runs_.size()), control_.threads,
                     [this](int i) { judge_setting(runs_[static_cast<std::size_t>(i)]); });
        tell_.clear();
        std::vector<std::string> told;
        const auto warn = [&](const std::vector<std::string>& warnings) {
            for (const std::string& warning : warnings) {
                if (std::find(told.begin(), told.end(), warning) != told.end()) continue;
                tell_.warn("warning: " + warning);
                told.push_back(warning);
            }
        };
        warn(warnings(job_));
        for (const PlannedRun& run : runs_) warn(specimen(run)->quality.warnings);
    }

private:
    // Side by side; a single one tells how far it is.
    void make_packings() {
        std::vector<const PlannedRun*> of_each;  // the first run on it
        std::set<std::string> seen;
        for (const PlannedRun& run : runs_)
            if (seen.insert(identity_of(specimen_of(run), run.seed)).second) of_each.push_back(&run);
        const int count = static_cast<int>(of_each.size());
        tell_.busy("making " + counted(count, "packing"));
        side_by_side(count, control_.threads, [&](int i) {
            const PlannedRun& run = *of_each[static_cast<std::size_t>(i)];
            Packings::Tell tell;
            if (count == 1) tell = [&](const SpecimenProgress& progress) { tell_.making(packing_stem(run), progress); };
            (void)packings_.get(specimen_of(run), run.seed, std::max(1, control_.threads / count), tell);
        });
    }

    // An unstable setting is refused here; what the program chooses itself is stable.
    void judge_setting(const PlannedRun& run) {
        if (*control_.stop) throw Interrupted();
        if (control_.device.open && !control_.device.where_possible)
            (void)opener_for(setup_of(run, specimen(run)), control_.device, {});
        if (control_.ranks != nullptr) {
            const int most = most_ranks(setup_of(run, specimen(run)));
            if (most < control_.ranks->size())
                throw InputError({.key = "mpirun"},
                                 fmt::format("{}: {} ranks cannot share the specimen: it has {} packs of grains, or rigid bodies",
                                             label_of(run), control_.ranks->size(), most),
                                 fmt::format("at most {} ranks", most), "a larger specimen, or fewer ranks");
        }
        const NumericsSpec& numerics = run.variant->numerics;
        if (numerics.kind == NumericsKind::adaptive && !numerics.mass_factor) return;
        RunControl judging;
        judging.stop = control_.stop;
        (void)preview_test(setup_of(run, specimen(run)), judging);
    }

    const Job& job_;
    const JobControl& control_;
    JobListener& tell_;
    std::vector<PlannedRun> runs_;
    Packings packings_;
};

// As RunDirectory::write() wants it: with the system's reason alone, since the directory knows the file by its final name.
void write_packing(const Specimen& specimen, const fs::path& file) {
    try {
        save_packing(specimen, file);
    } catch (const OutputError& error) {
        std::rethrow_if_nested(error);
        throw;
    }
}

// In words for the user.
std::string reason_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const std::exception& problem) {
        const std::string lack = lack_of_memory(problem, "it");
        return lack.empty() ? problem.what() : lack;
    }
}

std::vector<LivePlan> live_plans(const PreparedRuns& runs) {
    std::vector<LivePlan> plans;
    for (const PlannedRun& run : runs.all()) {
        const MethodWords& words = method_of(*run.test).words;
        plans.push_back({label_of(run), title(run.variant->name, *run.test), words.stress, words.strain});
    }
    return plans;
}

LiveResult live_result(const TestResult& result) {
    std::string words = fmt::format("{:.4g} MPa, grade {}", result.properties.peak_stress_Pa / 1e6, result.evidence.grade);
    if (!result.properties.peak_reached) words += ", peak not reached";
    if (result.stop_reason == kEndedByUser || result.interrupted) words += ", " + result.stop_reason;
    return {LiveState::ended, words};
}

// Takes what tests leave into the job's directory.
class DirectorySink final : public RunSink {
public:
    /// @param found  where an unfinished run of the job is gone on with
    /// @param leader  of several ranks; null: alone
    DirectorySink(const Job& job, PreparedRuns& runs, const JobControl& control, FoundPlace found, JobLeader* leader)
        : job_(job),
          leader_(leader),
          runs_(runs),
          control_(control),
          tell_(*control.listener),
          directory_(found.unfinished ? RunDirectory::open(*found.unfinished) : RunDirectory::create(control.out, job.name)),
          lock_(found.unfinished ? std::move(*found.lock) : begin_unfinished(directory_, job)) {
        if (control_.live != nullptr) control_.live->planned(live_plans(runs_));
        directory_.write_text("job.toml", job_.text);
        directory_.write_text("job-resolved.toml", resolved_toml_in_given_units(job_));
        if (!found.unfinished) {
            tell_.note(fmt::format("results go to {}", directory_.path().string()));
            return;
        }
        mark_unfinished(directory_, job_);
        for (const fs::directory_entry& entry : fs::directory_iterator(directory_.path()))  // states and fields
            if (entry.is_directory()) (void)RunDirectory::open(entry.path());               // removes what was half written
        for (std::size_t i = 0; i < runs_.count(); ++i) take_found(i);
        tell_.note(fmt::format("going on with the unfinished run in {}: {} of {} are done (--fresh begins anew)",
                               directory_.path().string(), results_.size(), counted(runs_.count(), "test")));
    }

    const fs::path& path() const { return directory_.path(); }
    /// Tests of which there is something.
    std::size_t tests() const { return results_.size(); }

    int bodies(std::size_t i) override { return runs_.bodies(i); }

    RunningTests::Work begin(std::size_t i) override {
        if (found_.contains(i)) return {};
        const PlannedRun& run = runs_[i];
        const std::shared_ptr<const Specimen> specimen = runs_.specimen(run);
        const bool given = specimen->spec.given_cells.given();  // no packing makes these cells again
        const std::string packing =
            given ? "cells" + packing_stem(run).substr(std::string_view("packing").size()) + ".tess" : packing_stem(run) + ".txt";
        if (control_.keep == Keep::all && packings_.insert(packing).second) {
            if (given)
                directory_.write_text(packing, cells_as_text(*specimen, CellFormat::tess));
            else
                directory_.write(packing, [&](const fs::path& file) { write_packing(*specimen, file); });
        }
        TestWatch* const watch = control_.live != nullptr ? &control_.live->begins(i, specimen) : nullptr;
        return [this, i, &run, specimen, watch](const RunControl& run_control) {
            const CheckpointOwner owner = owner_of(run);
            TestCheckpoints checkpoints(
                directory_, kept_as(run, ".state"), owner, control_.checkpoints,
                [this, i](const std::string& line) { notes_.add(fmt::format("{}: {}", numbered_label(i), line)); });
            RunControl own_control = run_control;
            own_control.keeper = &checkpoints;
            own_control.watch = watch;
            own_control.failed = [&](const TestResult& record) { write_failed(run, record); };
            const TestSetup setup = setup_of(run, specimen);
            own_control.device = opener_for(setup, control_.device, [this, i](const std::string& line) {
                notes_.add(fmt::format("{}: {}", numbered_label(i), line));
            });
            TestResult result = leader_ ? leader_->run(i, setup, own_control) : run_test(setup, own_control);
            result.variant = run.variant->name;
            if (result.history.empty()) return result;  // interrupted before the first row
            write_record(result);
            if (result.interrupted) return result;
            try {
                write_checkpoint(directory_, kept_as(run, ".result"), owner,
                                 [&](const StatePut& put) { keep_result(result, put); });
                remove_checkpoint(directory_.path(), kept_as(run, ".state"));
            } catch (const OutputError& error) {  // its results are there
                notes_.add(fmt::format("{}: if this run is ended, this test is made again: {}", numbered_label(i), error.what()));
            }
            return result;
        };
    }

    void beat() override {
        for (const std::string& line : notes_.take()) tell_.warn(line);
    }

    void progress(std::size_t i, const TestProgress& state) override {
        if (control_.live != nullptr) control_.live->progress(i, state);
        tell_.progress(number_of(i), static_cast<int>(runs_.count()), label_of(runs_[i]), state);
    }

    void ended(std::size_t i) override {
        if (control_.live != nullptr) control_.live->written(i);
        tell_.ended(number_of(i));
    }

    // Writes what holds all tests, and the archive, of which only one is made at a time.
    void finished(std::size_t i, TestResult ended) override {
        beat();
        tell_.finished(numbered_label(i), ended);
        if (control_.live != nullptr) control_.live->ended(i, live_result(ended));
        if (ended.history.empty()) return;
        const TestResult& result = add(i, std::move(ended));
        if (control_.keep == Keep::all) write_hdf5(directory_, result, job_, control_.provenance);
        if (results_.size() < runs_.count()) write_overview(false, false);
    }

    // The other tests go on. @throws OutputError: what is still running could not be written either
    void failed(std::size_t i, const std::exception_ptr& error) override {
        beat();  // what the test has said on the way
        try {
            std::rethrow_exception(error);
        } catch (const Interrupted&) {
            if (control_.live != nullptr) control_.live->ended(i, {LiveState::ended, "ended before its first record"});
            return;  // before there was anything to keep of this test
        } catch (const OutputError&) {
            throw;
        } catch (...) {
            reasons_[i] = reason_of(error);
        }
        if (control_.live != nullptr) control_.live->ended(i, {LiveState::failed, "failed: " + reasons_[i]});
        tell_.warn(fmt::format("{}: failed: {}", numbered_label(i), reasons_[i]));
        if (results_.size() + reasons_.size() < runs_.count()) write_overview(false, false);
    }

    /// The last overview, when all have ended.
    JobOutcome outcome() {
        beat();
        tell_.clear();
        JobOutcome outcome;
        outcome.directory = directory_.path();
        outcome.tests = runs_.count();
        outcome.interrupted =
            results_.size() + reasons_.size() < runs_.count() ||
            std::any_of(results_.begin(), results_.end(), [](const TestResult& result) { return result.interrupted; });
        write_overview(!outcome.interrupted && reasons_.empty(), true);
        outcome.failed = failures();
        outcome.results = std::move(results_);
        outcome.properties = std::move(properties_);
        if (!outcome.interrupted && outcome.failed.empty())
            end_unfinished(directory_.path());  // what failed is tried again by whoever runs the job here again
        return outcome;
    }

private:
    // What a test's own thread writes.
    void write_record(const TestResult& result) const {
        if (control_.keep == Keep::numbers) return;
        write_history_csv(directory_, result, control_.provenance);
        write_events_csv(directory_, result);
    }

    // What there is of a test whose motion became unstable: it never comes to finished().
    void write_failed(const PlannedRun& run, const TestResult& record) const {
        TestResult result = record;
        result.variant = run.variant->name;
        write_record(result);
        if (control_.keep == Keep::all) write_hdf5(directory_, result, job_, control_.provenance);
    }

    // Name of a file that is kept of a run until the job is complete.
    static std::string kept_as(const PlannedRun& run, const char* extension) {
        return fmt::format("{}/{}{}", kCheckpoints, test_stem(run.variant->name, *run.test, run.seed), extension);
    }
    CheckpointOwner owner_of(const PlannedRun& run) const {
        return CheckpointOwner::of(
            fmt::format("{} {}", make_run(job_, *run.variant, *run.test, run.seed).id, run.test->snapshots), control_.provenance);
    }

    // A test that had ended when the program was.
    void take_found(std::size_t i) {
        const PlannedRun& run = runs_[i];
        Checkpoint kept = read_checkpoint(directory_.path(), kept_as(run, ".result"), owner_of(run));
        try {
            if (!kept.refused.empty()) throw StateError(kept.refused);
            if (kept.state.empty()) return;
            TestResult result = kept_result(setup_of(run, runs_.specimen(run)), kept.state);
            result.variant = run.variant->name;
            found_.insert(i);
            const TestResult& here = add(i, std::move(result));
            if (control_.live != nullptr) control_.live->ended(i, live_result(here));
            if (!fs::exists(directory_.path() / ("history-" + test_stem(here) + ".csv")))
                write_record(here);  // it was begun with another `keep`
            if (control_.keep == Keep::all && !fs::exists(directory_.path() / (test_stem(here) + ".h5")))
                write_hdf5(directory_, here, job_, control_.provenance);
        } catch (const StateError& error) {
            tell_.warn(
                fmt::format("{}: what it had left is not used, and it is made again: {}", numbered_label(i), error.what()));
        }
    }

    // In the job's order.
    const TestResult& add(std::size_t i, TestResult result) {
        const auto place = std::upper_bound(order_.begin(), order_.end(), i) - order_.begin();
        order_.insert(order_.begin() + place, i);
        return *results_.insert(results_.begin() + place, std::move(result));
    }

    static int number_of(std::size_t i) { return static_cast<int>(i) + 1; }
    std::string numbered_label(std::size_t i) const {
        return fmt::format("{}/{} {}", number_of(i), runs_.count(), label_of(runs_[i]));
    }

    std::vector<FailedTest> failures() const {
        std::vector<FailedTest> list;
        for (const auto& [i, reason] : reasons_) list.push_back({runs_[i].variant->name, *runs_[i].test, runs_[i].seed, reason});
        return list;
    }

    // The report of many tests takes a second to make: on the way it may take a twentieth of the time.
    void write_overview(bool complete, bool last) {
        if (!job_.has_variants()) properties_ = summarise(results_);  // else each variant has its own
        const std::vector<FailedTest> failed = failures();
        write_summary(directory_, job_, results_, properties_, control_.provenance, complete, failed);
        const Clock::time_point start = Clock::now();
        if (!last && start < next_report_) return;
        write_report(directory_, job_, results_, properties_, control_.provenance, complete, failed);
        if (control_.live != nullptr) control_.live->report(directory_.path() / "report.html");
        next_report_ = Clock::now() + 20 * (Clock::now() - start);
    }

    const Job& job_;
    JobLeader* leader_;
    PreparedRuns& runs_;
    const JobControl& control_;
    JobListener& tell_;
    RunDirectory directory_;
    FileLock lock_;
    std::set<std::size_t> found_;  // ended when an earlier program did
    Notes notes_;
    std::set<std::string> packings_;              // written already
    std::vector<TestResult> results_;             // in the job's order
    std::vector<std::size_t> order_;              // the number of each
    std::map<std::size_t, std::string> reasons_;  // of failures, by number
    PropertySummary properties_;
    Clock::time_point next_report_;
};

}  // namespace

JobOutcome run_job(const Job& job, const JobControl& control) {
    std::optional<JobLeader> leader;  // whatever ends the job here, ends it for the others
    if (control.ranks != nullptr) leader.emplace(*control.ranks);
    PreparedRuns runs(job, control);
    FoundPlace found = find_place(control.out, job, control.fresh);
    if (control.go_on && !found.unfinished) {
        const std::string place = control.out ? "'" + *control.out + "'" : "'results/" + job.name + "-<n>'";
        throw InputError({{}, 0, 0, "--continue"}, fmt::format("there is no unfinished run of this job in {}", place),
                         "the directory of a run of the same job that was ended, or the command without --continue");
    }
    if (!found.unfinished) RunDirectory::check(control.out, job.name);
    check_space(control.out, runs.all(), control.keep);
    runs.prepare();
    DirectorySink sink(job, runs, control, std::move(found), leader ? &*leader : nullptr);
    try {
        run_in_order(runs.count(), Sharing(leader ? 1 : job.at_once, control.threads), *control.stop, sink);
        return sink.outcome();
    } catch (const std::exception&) {
        control.listener->broken_off(sink.tests(), sink.path());
        throw;
    }
}

}  // namespace feldspar
