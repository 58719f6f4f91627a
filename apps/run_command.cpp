#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
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
#include "progress.hpp"
#include "say.hpp"
#include "tables.hpp"
#include "terminal.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

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
void print_tables(std::FILE* where, std::size_t columns, const Job& job, const JobOutcome& outcome) {
    const std::string properties =
        job.has_variants() ? variant_table(job, outcome.results, columns) : property_table(job, outcome.properties, columns);
    say(where, "\n{}\n{}\n", test_table(outcome.results, outcome.failed, columns), properties);
    say(where, "Report: {}\n", (outcome.directory / "report.html").string());
}

// summary.json, and where it is.
Json summary_of(const JobOutcome& outcome) {
    Json json{{"directory", outcome.directory.string()},
              {"report", (outcome.directory / "report.html").string()},
              {"interrupted", outcome.interrupted}};
    std::ifstream file(outcome.directory / "summary.json");
    const Json summary = Json::parse(file, nullptr, false);
    if (!summary.is_object())
        throw OutputError(fmt::format("'{}' cannot be read again", (outcome.directory / "summary.json").string()));
    for (const auto& [key, value] : summary.items()) json[key] = value;
    return json;
}

void print_json(const Json& json) { put(stdout, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"); }

void print_results(const RunOptions& options, const Job& job, const JobOutcome& outcome) {
    if (options.json) print_json(summary_of(outcome));
    if (!options.quiet)
        print_tables(options.json ? stderr : stdout, options.json ? error_columns() : output_columns(), job, outcome);
    else if (!options.json)
        say("{}\n", outcome.directory.string());
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

ExitCode run_and_print(const RunOptions& options) {
    install_signal_handlers();
    const std::unique_ptr<Communicator> ranks = communicator_here();
    refuse_with_ranks(options, *ranks);
    const auto read = [&options] { return job_with_options(options); };
    const Job job = ranks->alone() ? read() : read_together(*ranks, read, collect_provenance(options.command_line, 1));
    const int threads = threads_of_rank(job, *ranks);
    if (!ranks->first()) return follow(job, *ranks, threads);
    LiveView live(options.live, job.name);
    JobProgress progress(options.quiet, live);
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
    print_results(options, job, outcome);
    std::fflush(stdout);
    live.over(outcome);
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
    if (!options.json) return run_and_print(options);
    try {
        return run_and_print(options);
    } catch (const InputError& error) {  // what programs that call this one want to show their users
        print_json({{"error",
                     {{"kind", "input"},
                      {"message", error.what()},
                      {"file", error.place().file},
                      {"line", error.place().line},
                      {"column", error.place().column},
                      {"key", error.place().key}}}});
        throw;
    }
}

}  // namespace feldspar
