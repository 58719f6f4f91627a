#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "device_option.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/study/planned_runs.hpp"
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

ExitCode run_and_print(const RunOptions& options) {
    install_signal_handlers();
    const Job job = job_with_options(options);
    LiveView live(options.live, job.name);
    JobProgress progress(options.quiet, live);
    JobControl control;
    control.live = live.board();
    control.threads = thread_count(job.threads);
    control.out = options.out;
    control.fresh = options.fresh;
    control.go_on = options.go_on;
    control.keep = options.keep;
    control.provenance = collect_provenance(options.command_line, control.threads);
    control.device = device_use(options.device, control.provenance);
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
