#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "device_option.hpp"
#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/calibration/calibration_files.hpp"
#include "feldspar/calibration/calibration_report.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "running_study.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

// Tells of the runs of a calibration, one line each when it ends.
class CalibrationProgress {
public:
    /// @param quiet  tells of failures alone
    CalibrationProgress(int budget, bool quiet) : budget_(budget), quiet_(quiet) { progress_.keep_log_short(); }

    void report(int number, const Run& run, const TestProgress& state) {
        if (!quiet_) progress_.report(number, budget_, label_of(run), state);
    }

    void ended(int number, const Run& run, const RunRecord& record) {
        progress_.ended(number);
        if (!quiet_ || record.state == RunState::failed)
            progress_.note(fmt::format("  {}/{} {}: {}", number, budget_, label_of(run), result_text(record)));
    }

    void note(const std::string& line) {
        if (!quiet_) progress_.note(line);
    }
    void warn(const std::string& line) { progress_.note(line); }
    void clear() { progress_.clear(); }

private:
    int budget_;
    bool quiet_;
    Progress progress_;
};

ExitCode run_and_print(const CalibrateOptions& options, Printing& print) {
    Calibration calibration = read_calibration(options.calibration, options.settings);
    if (options.results) calibration.results = *options.results;
    if (options.budget) calibration.budget = *options.budget;
    const std::vector<std::string> contradicting = contradictions(calibration.targets);
    for (const std::string& sentence : contradicting) say(stderr, "{}\n", sentence);
    if (!contradicting.empty() && !options.insist)
        throw InputError({options.calibration, 0, 0, "targets"}, "the targets contradict each other, so no run was made",
                         "targets of one rock, or --insist to see how near one can come");

    check_budget(calibration);

    LiveView live(options.live, calibration.name, words_of("calibration"));
    Ledger ledger(calibration.results, Ledger::Access::write);
    CalibrationProgress progress(calibration.budget, print.quiet());
    ExecuteControl control;
    control.threads = thread_count(options.threads.value_or(0));
    control.at_once = options.at_once.value_or(0);
    control.keep = Keep::numbers;
    control.retry_failed = options.retry_failed;
    control.stop = &stop_requested();
    control.checkpoints = checkpoint_settings();
    control.provenance = collect_provenance(options.command_line, control.threads);
    control.device = device_use(options.device, control.provenance);
    const RunLaboratory* running = nullptr;
    control.progress = [&](const Run& run, const TestProgress& state) { progress.report(running->number_of(run), run, state); };
    control.ended = [&](const Run& run, const RunRecord& record) { progress.ended(running->number_of(run), run, record); };
    control.note = [&](const std::string& line) { progress.warn(line); };
    std::optional<LiveRuns> shown;
    if (live.board() != nullptr) {
        live.board()->expects(static_cast<std::size_t>(calibration.budget));
        control.live = &shown.emplace(
            *live.board(), [](const Run& run) { return label_of(run); }, result_text);
    }
    RunLaboratory laboratory(calibration, ledger, control);
    running = &laboratory;
    progress.note(fmt::format("{}: {} targets, {} unknowns, at most {} runs; results in {}", calibration.name,
                              calibration.targets.size(), calibration.unknowns.size(), calibration.budget,
                              calibration.results.string()));
    const CalibrationResult result = calibrate(calibration, laboratory, [&](const std::string& line) {
        progress.note(line);
        live.busy(line);
    });
    progress.clear();
    if (!result.complete) {
        say(stderr, "interrupted after {} runs, which are kept; the same command goes on\n", result.runs);
        print.end(calibration.results, [&] {
            return Json{
                {"directory", calibration.results.string()}, {"page", nullptr}, {"interrupted", true}, {"runs", result.runs}};
        });
        live.over(fmt::format("It was ended early, after {} runs; the same command goes on.", result.runs));
        return ExitCode::interrupted;
    }
    const RunDirectory directory = RunDirectory::open(calibration.results);
    directory.write_text("calibration.json", calibration_json(calibration, result, control.provenance));
    directory.write_text("calibrated.toml", calibrated_job(calibration, result));
    write_calibration_report(calibration, result, control.provenance, calibration_page(calibration));
    const std::string job = (calibration.results / "calibrated.toml").string();
    print.say_results("\n{}\nJob with the best set: {}\nReport: {}\n", calibration_text(result, print.columns()), job,
                      calibration_page(calibration).string());
    print.end(calibration.results, [&] {
        return with_file({{"directory", calibration.results.string()},
                          {"page", calibration_page(calibration).string()},
                          {"job", job},
                          {"interrupted", false}},
                         calibration.results / "calibration.json");
    });
    if (live.board() != nullptr) live.board()->report(calibration_page(calibration));
    live.over(fmt::format("It has its answer, after {} runs. This page is the report of the calibration as it stands in {}.",
                          result.runs, calibration_page(calibration).string()));
    return ExitCode::success;
}

}  // namespace

ExitCode calibrate_command(const CalibrateOptions& options) {
    install_signal_handlers();
    return printing(options.print, [&](Printing& print) { return run_and_print(options, print); });
}

}  // namespace feldspar
