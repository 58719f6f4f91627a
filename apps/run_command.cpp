#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <new>
#include <optional>

#include "campaign.hpp"
#include "commands.hpp"
#include "feldspar/base/parallel.hpp"
#include "feldspar/base/usable_cores.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/study/running_tests.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "say.hpp"
#include "tables.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

// Bytes that the job will leave, roughly: fields at the snapshots in two formats, histories and the report.
double expected_bytes(const Job& job, const std::vector<PlannedRun>& runs) {
    double bytes = 1e6;
    for (const PlannedRun& run : runs) {
        const double grains = grain_count(specimen_of(job, *run.test));
        bytes += 1e6 + 500.0 * grains * (run.test->snapshots + 4);
    }
    return bytes;
}

void check_space(const std::optional<std::string>& out, const Job& job, const std::vector<PlannedRun>& runs) {
    std::error_code error;
    fs::path place = fs::absolute(out ? fs::path(*out) : fs::path("results"), error);
    while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
    const fs::space_info space = fs::space(place, error);
    if (error || space.capacity == 0) return;  // a file system that does not tell is not full
    const double wanted = expected_bytes(job, runs);
    if (static_cast<double>(space.available) < wanted)
        throw InputError({{}, 0, 0, "--out"},
                         fmt::format("the results need about {:.0f} MB, but the disk of '{}' has only {:.0f} MB free",
                                     wanted / 1e6, place.string(), static_cast<double>(space.available) / 1e6),
                         "a directory on a disk with more space, or fewer snapshots");
}

// One campaign: makes everything, runs the tests, and writes each test's files as soon as it has ended.
class Campaign {
public:
    Campaign(const Job& job, const RunOptions& options)
        : job_(job), runs_(planned_runs(job)), specimens_(job), threads_(thread_count(job.threads)) {
        RunDirectory::check(options.out, job.name);
        check_space(options.out, job, runs_);
        provenance_ = collect_provenance(options.command_line, threads_);
    }

    /// Makes every specimen and judges every setting of the user's, so that a mistake shows before there is a directory.
    void prepare() {
        if (stop_requested()) throw Interrupted();
        const int packings = specimens_.missing(runs_);
        progress_.busy(fmt::format("making {} packing{}", packings, packings == 1 ? "" : "s"));
        specimens_.make(runs_, threads_, [this](const std::string& what, const SpecimenProgress& p) { progress_.making(what, p); });
        side_by_side(static_cast<int>(runs_.size()), threads_, [this](int i) { judge_setting(runs_[static_cast<std::size_t>(i)]); });
        progress_.clear();
        for (const std::string& warning : warnings(job_)) warn(warning);
        for (const PlannedRun& run : runs_)
            for (const std::string& warning : specimens_.get(run)->quality.warnings) warn(warning);
    }

    void create_directory(const std::optional<std::string>& out) {
        directory_ = RunDirectory::create(out, job_.name);
        progress_.note(fmt::format("results go to {}", directory_->path().string()));
        directory_->write_text("job.toml", job_.text);
        directory_->write_text("job-resolved.toml", resolved_toml(job_));
    }

    /// Runs everything. A test that fails is noted, and the others go on. @throws OutputError when results cannot be written
    void run() {
        RunningTests running(Sharing(job_.at_once, threads_), stop_requested());
        std::size_t next = 0;
        while (true) {
            while (may_start(running, next)) start(running, next++);
            running.share_out_free_threads();
            if (running.count() == 0 && ended_.empty()) break;
            // files are written only when every thread has something to do
            if (ended_.empty()) {
                listen(running.events(true));
            } else {
                take(std::move(ended_.front()));
                ended_.pop_front();
                listen(running.events(false));
            }
        }
        progress_.clear();
        interrupted_ = results_.size() + failed_.size() < runs_.size() ||
                       std::any_of(results_.begin(), results_.end(), [](const TestResult& result) { return result.interrupted; });
        write_overview(!interrupted_ && failed_.empty(), true);
    }

    bool interrupted() const { return interrupted_; }
    bool has_failed() const { return !failed_.empty(); }

    /// @throws NumericalError that names the first failed test in the job's order, if any failed
    void throw_if_failed() const {
        if (failed_.empty()) return;
        const auto& [i, reason] = *failed_.begin();
        throw NumericalError(fmt::format("{}: {} ({} of {} tests failed; the results of the others are kept)", label_of(runs_[i]), reason, failed_.size(), runs_.size()));
    }

    void print_results() const {
        const std::string properties = job_.has_variants() ? variant_table(job_, results_) : property_table(job_, properties_);
        say("\n{}\n{}\n", properties, test_table(results_, failures()));
        say("Report: {}\n", (directory_->path() / "report.html").string());
    }

    /// Where the results are, once there is a place.
    std::optional<fs::path> place() const { return directory_ ? std::optional<fs::path>(directory_->path()) : std::nullopt; }
    std::size_t finished() const { return results_.size(); }

private:
    static std::string label_of(const PlannedRun& run) {
        return fmt::format("{}, seed {}", title(run.variant->name, *run.test), run.seed);
    }

    // An unstable setting is refused here; what the program chooses itself is stable.
    void judge_setting(const PlannedRun& run) {
        if (stop_requested()) throw Interrupted();
        const NumericsSpec& numerics = run.variant->numerics;
        if (numerics.kind == NumericsKind::adaptive && !numerics.mass_factor) return;
        RunControl control;
        control.stop = &stop_requested();
        (void)preview_test(setup_of(run, specimens_.get(run)), control);
    }

    int bodies(std::size_t i) { return body_count(runs_[i], *specimens_.get(runs_[i])); }

    // Tests start in the job's order, so that an interrupted job leaves whole packings behind.
    bool may_start(const RunningTests& running, std::size_t next) {
        return next < runs_.size() && !stop_requested() && running.has_room_for(bodies(next));
    }

    void start(RunningTests& running, std::size_t i) {
        const PlannedRun& run = runs_[i];
        const std::shared_ptr<const Specimen> specimen = specimens_.get(run);
        const std::string packing = Specimens::packing_stem(run) + ".txt";
        if (std::find(packings_.begin(), packings_.end(), packing) == packings_.end()) {
            directory_->write(packing, [&](const fs::path& file) { save_packing(*specimen, file); });
            packings_.push_back(packing);
        }
        running.start(i, bodies(i), runs_.size() - i, [this, &run, specimen](const RunControl& control) {
            TestResult result = run_test(setup_of(run, specimen), control);
            result.variant = run.variant->name;
            if (!result.history.empty()) {   // else interrupted before the first row
                write_history_csv(*directory_, result, provenance_);
                write_vtu(*directory_, result, *control.more_threads);
            }
            return result;
        });
    }

    // Shows what running tests tell, and puts those that have ended aside until there is time to write.
    void listen(RunningTests::Events events) {
        const int count = static_cast<int>(runs_.size());
        for (const auto& [i, state] : events.news) progress_.report(number_of(i), count, label_of(runs_[i]), state);
        for (RunningTests::Ended& test : events.ended) {
            progress_.ended(number_of(test.number));
            if (test.error) note_failure(test.number, test.error);
            ended_.push_back(std::move(test));
        }
    }

    static int number_of(std::size_t i) { return static_cast<int>(i) + 1; }

    // The other tests go on. @throws OutputError at once: what is still running could not be written either
    void note_failure(std::size_t i, const std::exception_ptr& error) {
        try {
            std::rethrow_exception(error);
        } catch (const Interrupted&) {
            // before there was anything to keep of this test
        } catch (const OutputError&) {
            throw;
        } catch (...) {
            failed_[i] = cause(error);
        }
    }

    std::vector<FailedTest> failures() const {
        std::vector<FailedTest> list;
        for (const auto& [i, reason] : failed_) list.push_back({runs_[i].variant->name, *runs_[i].test, runs_[i].seed, reason});
        return list;
    }

    // Writes what only this thread may write: the HDF5 library is not made for several, and the overview holds all tests.
    void take(RunningTests::Ended test) {
        const std::string label = fmt::format("{}/{} {}", number_of(test.number), runs_.size(), label_of(runs_[test.number]));
        if (failed_.contains(test.number)) {
            progress_.note(fmt::format("{}: failed: {}", label, failed_.at(test.number)));
            if (results_.size() + failed_.size() < runs_.size()) write_overview(false, false);
            return;
        }
        if (!test.result) return;
        progress_.note(fmt::format("{}: {}", label, test_line(*test.result)));
        if (test.result->history.empty()) return;
        const auto place = std::upper_bound(order_.begin(), order_.end(), test.number) - order_.begin();
        order_.insert(order_.begin() + place, test.number);
        const auto result = results_.insert(results_.begin() + place, std::move(*test.result));
        write_hdf5(*directory_, *result, job_, provenance_);
        if (results_.size() < runs_.size()) write_overview(false, false);
    }

    static std::string cause(const std::exception_ptr& error) {
        try {
            std::rethrow_exception(error);
        } catch (const std::bad_alloc&) {
            return "there is not enough memory for it";
        } catch (const std::exception& problem) {
            return problem.what();
        }
    }

    // The report of many tests takes a second to make: on the way it may take a twentieth of the time.
    void write_overview(bool complete, bool last) {
        using Clock = std::chrono::steady_clock;
        if (!job_.has_variants()) properties_ = summarise(results_);  // else each variant has its own
        const std::vector<FailedTest> failed = failures();
        write_summary(*directory_, job_, results_, properties_, provenance_, complete, failed);
        const Clock::time_point start = Clock::now();
        if (!last && start < next_report_) return;
        write_report(*directory_, job_, results_, properties_, provenance_, complete, failed);
        next_report_ = Clock::now() + 20 * (Clock::now() - start);
    }

    void warn(const std::string& warning) {
        if (std::find(warned_.begin(), warned_.end(), warning) != warned_.end()) return;
        progress_.note("warning: " + warning);
        warned_.push_back(warning);
    }

    const Job& job_;
    std::vector<PlannedRun> runs_;
    Specimens specimens_;
    int threads_;
    Provenance provenance_;
    Progress progress_;
    std::optional<RunDirectory> directory_;
    std::deque<RunningTests::Ended> ended_;              // not written yet
    std::vector<TestResult> results_;                    // in the job's order, whatever the order in which they ended
    std::vector<std::size_t> order_;                     // the number of each
    std::map<std::size_t, std::string> failed_;          // why, by number
    std::chrono::steady_clock::time_point next_report_;
    PropertySummary properties_;
    std::vector<std::string> packings_;  // written already
    std::vector<std::string> warned_;
    bool interrupted_ = false;
};

}  // namespace

// Leaves the variants that the command line names, in the job's order.
void keep_variants(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    if (!job.has_variants()) throw InputError({{}, 0, 0, "--variant"}, "the job has no variants", "the job as it is, without --variant");
    std::vector<std::string_view> names;
    for (const Variant& variant : job.variants) names.push_back(variant.name);
    const auto is = [](const Variant& variant, const std::string& name) { return variant.name == name || variant.stem == name; };
    for (const std::string& name : wanted)
        if (std::none_of(job.variants.begin(), job.variants.end(), [&](const Variant& variant) { return is(variant, name); }))
            throw InputError({{}, 0, 0, "--variant"}, fmt::format("the job has no variant '{}'", name), fmt::format("{}", fmt::join(names, "; ")),
                             did_you_mean(name, names));
    std::erase_if(job.variants, [&](const Variant& variant) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const std::string& name) { return is(variant, name); });
    });
}

// Leaves the tests of the kinds that the command line names.
void keep_tests(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    std::vector<std::string_view> kinds;
    for (const TestSpec& test : job.tests)
        if (std::find(kinds.begin(), kinds.end(), name(test.kind)) == kinds.end()) kinds.emplace_back(name(test.kind));
    for (const std::string& kind : wanted)
        if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
            throw InputError({{}, 0, 0, "--test"}, fmt::format("the job has no test '{}'", kind), listed(kinds), did_you_mean(kind, kinds));
    std::erase_if(job.tests, [&](const TestSpec& test) { return std::find(wanted.begin(), wanted.end(), name(test.kind)) == wanted.end(); });
    for (const Variant& variant : job.variants)
        if (std::none_of(job.tests.begin(), job.tests.end(), [&](const TestSpec& test) { return variant.runs(test.kind); }))
            throw InputError({{}, 0, 0, "--test"}, fmt::format("nothing is left to run for the variant '{}'", variant.name), {}, "name the --variant too");
}

Job job_with_options(const JobOptions& options) {
    Job job = read_job(options.job);
    keep_variants(job, options.variants);
    keep_tests(job, options.tests);
    if (options.threads) job.threads = *options.threads;
    if (options.at_once) job.at_once = *options.at_once;
    if (options.seeds.empty()) return job;
    for (std::uint64_t seed : options.seeds)
        if (std::count(options.seeds.begin(), options.seeds.end(), seed) > 1)
            throw InputError({{}, 0, 0, "--seed"}, fmt::format("the seed {} is given twice", seed), "each seed once");
    if (!job.specimen.packing_file.empty() && options.seeds.size() > 1)
        throw InputError({{}, 0, 0, "--seed"}, "several seeds are asked for, but the job loads one packing", "one seed");
    job.seeds = options.seeds;
    for (TestSpec& test : job.tests) test.seeds.clear();
    for (Variant& variant : job.variants) variant.seeds.clear();
    return job;
}

int thread_count(int wanted) {
    const int cores = usable_cores();
    if (wanted == 0) return cores;
    if (wanted > cores)
        say(stderr, "warning: {} threads on {} core{} will wait for each other\n", wanted, cores, cores == 1 ? "" : "s");
    return wanted;
}

ExitCode run_command(const RunOptions& options) {
    install_signal_handlers();
    const Job job = job_with_options(options);
    Campaign campaign(job, options);
    campaign.prepare();
    campaign.create_directory(options.out);
    const auto tell_place = [&] {
        say(stderr, "the files of {} finished test{} are in {}\n", campaign.finished(), campaign.finished() == 1 ? "" : "s",
            campaign.place()->string());
    };
    try {
        campaign.run();
    } catch (const std::exception&) {
        tell_place();
        throw;
    }
    campaign.print_results();
    if (campaign.has_failed()) {
        std::fflush(stdout);
        tell_place();
        campaign.throw_if_failed();
    }
    if (!campaign.interrupted()) return ExitCode::success;
    say(stderr, "interrupted; the results so far are in {}\n", campaign.place()->string());
    return ExitCode::interrupted;
}

}  // namespace feldspar
