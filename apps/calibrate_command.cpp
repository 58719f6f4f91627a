#include <fmt/format.h>

#include "commands.hpp"
#include "device_option.hpp"
#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/calibration/calibration_files.hpp"
#include "feldspar/calibration/calibration_report.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "running_study.hpp"
#include "say.hpp"
#include "terminal.hpp"

namespace feldspar {
namespace {

// Tells of the runs of a calibration, one line each when it ends.
class CalibrationProgress {
public:
    explicit CalibrationProgress(int budget) : budget_(budget) { progress_.keep_log_short(); }

    void report(int number, const Run& run, const TestProgress& state) {
        progress_.report(number, budget_, label_of(run), state);
    }

    void ended(int number, const Run& run, const RunRecord& record) {
        progress_.ended(number);
        progress_.note(fmt::format("  {}/{} {}: {}", number, budget_, label_of(run), result_text(record)));
    }

    void note(const std::string& line) { progress_.note(line); }
    void clear() { progress_.clear(); }

private:
    int budget_;
    Progress progress_;
};

}  // namespace

ExitCode calibrate_command(const CalibrateOptions& options) {
    install_signal_handlers();
    Calibration calibration = read_calibration(options.calibration);
    if (options.results) calibration.results = *options.results;
    if (options.budget) calibration.budget = *options.budget;
    const std::vector<std::string> contradicting = contradictions(calibration.targets);
    for (const std::string& sentence : contradicting) say(stderr, "{}\n", sentence);
    if (!contradicting.empty() && !options.insist)
        throw InputError({options.calibration, 0, 0, "targets"}, "the targets contradict each other, so no run was made",
                         "targets of one rock, or --insist to see how near one can come");

    check_budget(calibration);

    Ledger ledger(calibration.results, Ledger::Access::write);
    CalibrationProgress progress(calibration.budget);
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
    control.note = [&](const std::string& line) { progress.note(line); };
    RunLaboratory laboratory(calibration, ledger, control);
    running = &laboratory;
    progress.note(fmt::format("{}: {} targets, {} unknowns, at most {} runs; results in {}", calibration.name,
                              calibration.targets.size(), calibration.unknowns.size(), calibration.budget,
                              calibration.results.string()));
    const CalibrationResult result = calibrate(calibration, laboratory, [&](const std::string& line) { progress.note(line); });
    progress.clear();
    if (!result.complete) {
        say(stderr, "interrupted after {} runs, which are kept; the same command goes on\n", result.runs);
        return ExitCode::interrupted;
    }
    const RunDirectory directory = RunDirectory::open(calibration.results);
    directory.write_text("calibration.json", calibration_json(calibration, result, control.provenance));
    directory.write_text("calibrated.toml", calibrated_job(calibration, result));
    write_calibration_report(calibration, result, control.provenance, calibration_page(calibration));
    say("\n{}\nJob with the best set: {}\nReport: {}\n", calibration_text(result, output_columns()),
        (calibration.results / "calibrated.toml").string(), calibration_page(calibration).string());
    return ExitCode::success;
}

}  // namespace feldspar
