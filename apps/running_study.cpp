#include "running_study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "device_option.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

// Tells of a study while it runs: a line for every run that ends, with what is left.
class StudyProgress {
public:
    /// @param program  runs that failed for good with it are not repeated; none if they are
    /// @param quiet    tells of failures alone
    StudyProgress(const Study& study, const Ledger& ledger, const Provenance* program, bool quiet)
        : study_(study), quiet_(quiet) {
        std::vector<std::string> ids;
        for (const Run& run : study.runs) numbers_.emplace(run.id, 0);
        for (const auto& [id, number] : numbers_) ids.push_back(id);
        int number = 0;
        for (const Run& run : study.runs)
            if (numbers_[run.id] == 0) numbers_[run.id] = ++number;
        const SettledRuns settled = settled_runs(ledger.find(ids), program);
        done_ = static_cast<int>(settled.done.size());
        failed_ = static_cast<int>(settled.failed.size());
        first_ = ended_ = done_ + failed_;
        progress_.keep_log_short();
    }

    int runs() const { return static_cast<int>(numbers_.size()); }
    /// Found in the ledger.
    int done() const { return done_; }
    int failed() const { return failed_; }

    void report(const Run& run, const TestProgress& progress) {
        if (!quiet_) progress_.report(numbers_[run.id], runs(), label_of(study_, run), progress);
    }

    void ended(const Run& run, const RunRecord& record) {
        ++ended_;
        progress_.ended(numbers_[run.id]);
        if (!quiet_ || record.state == RunState::failed)
            progress_.note(fmt::format("{}/{} {}: {}{}", ended_, runs(), label_of(study_, run), result_text(record), left()));
    }

    void note(const std::string& line) {
        if (!quiet_) progress_.note(line);
    }
    void warn(const std::string& line) { progress_.note(line); }
    void clear() { progress_.clear(); }

private:
    // The rest, at the pace of this call so far.
    std::string left() const {
        const int rest = runs() - ended_;
        if (rest <= 0) return {};
        const double passed = seconds_since(start_);
        return fmt::format("; about {} left", duration_text(passed / (ended_ - first_) * rest));
    }

    const Study& study_;
    bool quiet_;
    std::map<std::string, int> numbers_;  // of each run, from 1 on
    int done_ = 0, failed_ = 0, ended_ = 0, first_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    Progress progress_;
};

}  // namespace

std::string label_of(const Run& run) { return fmt::format("{}, seed {}", title(run.test()), run.seed()); }

std::string label_of(const Study& study, const Run& run) {
    std::string text;
    for (const AxisValue& value : study.points[run.point].values) text += (text.empty() ? "" : ", ") + value.label;
    return text + (text.empty() ? "" : ": ") + label_of(run);
}

std::string result_text(const RunRecord& record) {
    if (record.state == RunState::failed) return "failed: " + record.reason;
    return fmt::format("{:.4g} MPa, grade {}, {}", record.numbers.at("strength_Pa") / 1e6, record.texts.at("grade"),
                       duration_text(record.numbers.at("wall_s")));
}

Execution run_study(const Study& study, Ledger& ledger, const StudyRunning& running, const Printing& print, LiveView& live) {
    ledger.enrol(study);
    ExecuteControl control;
    control.provenance = collect_provenance(running.command_line, running.threads);
    control.device = device_use(running.device, control.provenance);
    control.retry_failed = running.retry_failed;
    StudyProgress progress(study, ledger, running.retry_failed ? nullptr : &control.provenance, print.quiet());
    const std::string failed = progress.failed() > 0 ? fmt::format(", {} failed before and not repeated", progress.failed()) : "";
    progress.note(fmt::format("{}: {} runs at {}, {} done already{}; results in {}", study.name, progress.runs(),
                              counted(study.points.size(), "point"), progress.done(), failed, study.results.string()));
    control.threads = running.threads;
    control.at_once = running.at_once;
    control.keep = study.keep;
    control.stop = &stop_requested();
    control.checkpoints = checkpoint_settings();
    control.progress = [&](const Run& run, const TestProgress& state) { progress.report(run, state); };
    control.ended = [&](const Run& run, const RunRecord& record) { progress.ended(run, record); };
    control.note = [&](const std::string& line) { progress.warn(line); };
    std::optional<GrowingPage> page;
    std::optional<LiveRuns> shown;
    if (live.board() != nullptr) {
        if (running.shows_points) page.emplace(study, ledger, *live.board());
        control.live = &shown.emplace(
            *live.board(), [&](const Run& run) { return label_of(study, run); }, result_text, page ? &*page : nullptr);
    }
    const Execution execution = execute(study.runs, ledger, control);
    progress.clear();
    return execution;
}

LiveWords words_of(const std::string& whole) { return {.whole = whole, .one = "run", .keeps_ended = false}; }

void end_live(LiveView& live, const std::string& whole, const Execution& execution, const std::filesystem::path& page) {
    if (live.board() == nullptr) return;
    const int done = execution.done + execution.found_done, failed = execution.failed + execution.found_failed;
    const std::string without = failed > 0 ? fmt::format(", {} without a result", failed) : "";
    const std::string how = execution.left > 0
                                ? fmt::format("It was ended early: {} done{}, {} left; the same command goes on with them.",
                                              counted(done, "run"), without, execution.left)
                                : fmt::format("{} have ended{}.", counted(done + failed, "run"), without);
    live.board()->report(page);
    live.over(fmt::format("{} This page is that of the {} as it stands in {}.", how, whole, page.string()));
}

void print_execution(const Study& study, const Execution& execution, const Printing& print) {
    print.say_results("{} runs done now, {} before, {} failed; {} of runs in {}\n", execution.done, execution.found_done,
                      execution.failed, duration_text(execution.run_s), duration_text(execution.wall_s));
    if (execution.found_failed > 0)
        print.say_results("{} failed before and were not repeated; --retry-failed runs them again\n", execution.found_failed);
    print.say_results("Ledger: {}\n", (study.results / "ledger.sqlite").string());
    if (execution.left > 0) say(stderr, "interrupted with {} runs left; the same command goes on with them\n", execution.left);
}

Json execution_json(const Study& study, const Execution& execution, const std::filesystem::path& page) {
    return {{"directory", study.results.string()},
            {"page", page.string()},
            {"ledger", (study.results / "ledger.sqlite").string()},
            {"interrupted", execution.left > 0},
            {"executed",
             {{"done", execution.done},
              {"done_before", execution.found_done},
              {"failed", execution.failed},
              {"failed_before", execution.found_failed},
              {"left", execution.left}}}};
}

ExitCode outcome(const Execution& execution) {
    if (execution.left > 0) return ExitCode::interrupted;
    return execution.failed + execution.found_failed > 0 ? ExitCode::numerical : ExitCode::success;
}

}  // namespace feldspar
