#include <fmt/format.h>

#include <cstdio>

#include "commands.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/study/planned_runs.hpp"

#include "feldspar/study/run_job.hpp"
#include "interrupt.hpp"
#include "live_view.hpp"
#include "progress.hpp"
#include "say.hpp"
#include "tables.hpp"

namespace feldspar {
namespace {

void tell_place(std::size_t tests, const std::filesystem::path& directory) {
    say(stderr, "the files of {} are in {}\n", counted(tests, "finished test"), directory.string());
}

// Shows on stderr what a job tells.
class JobProgress final : public JobListener {
public:
    explicit JobProgress(LiveView& live) : live_(live) {}
    void busy(const std::string& what) override {
        progress_.busy(what);
        live_.busy(what);
    }
    void making(const std::string& packing, const SpecimenProgress& state) override { progress_.making(packing, state); }
    void note(const std::string& line) override { progress_.note(line); }
    void progress(int number, int count, const std::string& label, const TestProgress& state) override { progress_.report(number, count, label, state); }
    void ended(int number) override { progress_.ended(number); }
    void finished(const std::string& label, const TestResult& result) override { progress_.note(fmt::format("{}: {}", label, test_line(result))); }
    void clear() override { progress_.clear(); }
    void broken_off(std::size_t tests, const std::filesystem::path& directory) override { tell_place(tests, directory); }

private:
    Progress progress_;
    LiveView& live_;
};

void print_results(const Job& job, const JobOutcome& outcome) {
    const std::string properties = job.has_variants() ? variant_table(job, outcome.results) : property_table(job, outcome.properties);
    say("\n{}\n{}\n", properties, test_table(outcome.results, outcome.failed));
    say("Report: {}\n", (outcome.directory / "report.html").string());
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
    install_signal_handlers();
    const Job job = job_with_options(options);
    LiveView live(options.live, job.name);
    JobProgress progress(live);
    JobControl control;
    control.live = live.board();
    control.threads = thread_count(job.threads);
    control.out = options.out;
    control.fresh = options.fresh;
    control.provenance = collect_provenance(options.command_line, control.threads);
    control.stop = &stop_requested();
    control.checkpoints = checkpoint_settings();
    control.listener = &progress;
    const JobOutcome outcome = run_job(job, control);
    print_results(job, outcome);
    std::fflush(stdout);
    live.over(outcome);
    if (!outcome.failed.empty()) {
        std::fflush(stdout);
        tell_place(outcome.results.size(), outcome.directory);
        const FailedTest& first = outcome.failed.front();
        throw NumericalError(fmt::format("{}, seed {}: {} ({} of {} tests failed; the results of the others are kept)", title(first.variant, first.test), first.seed,
                                         first.reason, outcome.failed.size(), outcome.tests));
    }
    if (!outcome.interrupted) return ExitCode::success;
    say(stderr, "interrupted; the results so far are in {}, and the same command goes on there\n", outcome.directory.string());
    return ExitCode::interrupted;
}

}  // namespace feldspar
