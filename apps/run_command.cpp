#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "device_option.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/base/usable_cores.hpp"
#include "feldspar/ranks/communicator.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "feldspar/study/ranked_job.hpp"
#include "feldspar/study/run_job.hpp"
#include "interrupt.hpp"
#include "live_view.hpp"
#include "printing.hpp"
#include "progress.hpp"
#include "tables.hpp"

namespace feldspar {
namespace {

void tell_place(std::size_t tests, const std::filesystem::path& directory) {
    say(stderr, "the files of {} are in {}\n", counted(tests, "finished test"), directory.string());
}

// Shows on stderr what a job tells; if it is to be quiet, only what should not be missed.
class JobProgress final : public JobListener {
public:
    JobProgress(bool quiet, LiveView& live) : quiet_(quiet), live_(live) {}

    void busy(const std::string& what) override {
        unless_quiet([&] { progress_.busy(what); });
        live_.busy(what);
    }
    void making(const std::string& packing, const SpecimenProgress& state) override {
        unless_quiet([&] { progress_.making(packing, state); });
    }
    void note(const std::string& line) override {
        unless_quiet([&] { progress_.note(line); });
    }
    void warn(const std::string& line) override { progress_.note(line); }
    void progress(int number, int count, const std::string& label, const TestProgress& state) override {
        unless_quiet([&] { progress_.report(number, count, label, state); });
    }
    void ended(int number) override { progress_.ended(number); }
    void finished(const std::string& label, const TestResult& result) override {
        note(fmt::format("{}: {}", label, test_line(result)));
    }
    void clear() override { progress_.clear(); }
    void broken_off(std::size_t tests, const std::filesystem::path& directory) override { tell_place(tests, directory); }

private:
    template <class Tell>
    void unless_quiet(Tell tell) {
        if (!quiet_) tell();
    }

    bool quiet_;
    Progress progress_;
    LiveView& live_;
};

// The properties last, where they stay in sight.
void print_tables(const Printing& print, const Job& job, const JobOutcome& outcome) {
    const std::size_t columns = print.columns();
    const std::string properties =
        job.has_variants() ? variant_table(job, outcome.results, columns) : property_table(job, outcome.properties, columns);
    print.say_results("\n{}\n{}\n", test_table(outcome.results, outcome.failed, columns), properties);
    print.say_results("Report: {}\n", (outcome.directory / "report.html").string());
}

// summary.json, and where it is.
Json summary_of(const JobOutcome& outcome) {
    return with_file({{"directory", outcome.directory.string()},
                      {"report", (outcome.directory / "report.html").string()},
                      {"interrupted", outcome.interrupted}},
                     outcome.directory / "summary.json");
}

// How the run ended, for its page.
std::string last_words(const JobOutcome& outcome) {
    std::string words =
        outcome.interrupted
            ? fmt::format("It was ended early, with results of {} of {}; the same command goes on there.", outcome.results.size(),
                          counted(outcome.tests, "test"))
            : fmt::format("{} have ended{}.", counted(outcome.tests, "test"),
                          outcome.failed.empty() ? "" : fmt::format(", {} without a result", outcome.failed.size()));
    return words +
           fmt::format(" This page is the report of the run as it stands in {}.", (outcome.directory / "report.html").string());
}

// What only one program can do. The same on all ranks.
void refuse_with_ranks(const RunOptions& options, const Communicator& ranks) {
    if (ranks.alone()) return;
    const auto refuse = [&](const char* option, const std::string& problem, const char* allowed) {
        throw InputError({{}, 0, 0, option}, fmt::format("{} ranks make this run together, and {}", ranks.size(), problem),
                         allowed);
    };
    if (options.job == "-") refuse("mpirun", "the standard input reaches the first one only", "the job in a file");
    if (options.device != "cpu") refuse("--device", "their steps are made on processors", "cpu, or one program without mpirun");
    if (options.live.on)
        refuse("--live", "a run that is watched may be led", "a run without --live, or one program without mpirun");
}

// Cores are shared by the ranks of a machine, unless the user says otherwise.
int threads_of_rank(const Job& job, const Communicator& ranks) {
    if (ranks.alone()) return thread_count(job.threads);
    return job.threads > 0 ? job.threads : std::max(1, usable_cores() / ranks.on_this_machine());
}

// Ranks but the first: what they throw here is theirs alone.
ExitCode follow(const Job& job, Communicator& ranks, int threads) {
    try {
        follow_job(job, ranks, threads, stop_requested());
        return ExitCode::success;
    } catch (const std::exception& error) {
        say(stderr, "feldspar: rank {} of {}: {}\n", ranks.rank(), ranks.size(), error.what());
        ranks.give_up(static_cast<int>(ExitCode::numerical));
        throw;
    }
}

ExitCode run_and_print(const RunOptions& options, Printing& print) {
    install_signal_handlers();
    const std::unique_ptr<Communicator> ranks = communicator_here();
    refuse_with_ranks(options, *ranks);
    const auto read = [&options] { return job_with_options(options); };
    const Job job = ranks->alone() ? read() : read_together(*ranks, read, collect_provenance(options.command_line, 1));
    const int threads = threads_of_rank(job, *ranks);
    if (!ranks->first()) return follow(job, *ranks, threads);
    LiveView live(options.live, job.name);
    JobProgress progress(print.quiet(), live);
    JobControl control;
    control.live = live.board();
    control.threads = threads;
    control.out = options.out;
    control.fresh = options.fresh;
    control.go_on = options.go_on;
    control.keep = options.keep;
    control.provenance = collect_provenance(options.command_line, control.threads);
    control.provenance.ranks = ranks->size();
    control.device = device_use(options.device, control.provenance);
    if (!ranks->alone()) {
        control.ranks = ranks.get();
        progress.note(
            fmt::format("{} ranks make the steps together, this one with {}", ranks->size(), counted(threads, "thread")));
    }
    control.stop = &stop_requested();
    control.checkpoints = checkpoint_settings();
    control.listener = &progress;
    const JobOutcome outcome = run_job(job, control);
    print_tables(print, job, outcome);
    print.end(outcome.directory, [&] { return summary_of(outcome); });
    live.over(last_words(outcome));
    if (!outcome.failed.empty()) {
        std::fflush(stdout);
        tell_place(outcome.results.size(), outcome.directory);
        const FailedTest& first = outcome.failed.front();
        throw NumericalError(fmt::format("{}, seed {}: {} ({} of {} tests failed; the results of the others are kept)",
                                         title(first.variant, first.test), first.seed, first.reason, outcome.failed.size(),
                                         outcome.tests));
    }
    if (!outcome.interrupted) return ExitCode::success;
    say(stderr, "interrupted; the results so far are in {}, and the same command goes on there\n", outcome.directory.string());
    return ExitCode::interrupted;
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
    return printing(options.print, [&](Printing& print) { return run_and_print(options, print); });
}

}  // namespace feldspar
