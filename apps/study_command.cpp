#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <map>

#include "commands.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/study_table.hpp"
#include "campaign.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace feldspar {
namespace {

std::string label_of(const Study& study, const Run& run) {
    std::string text;
    for (const AxisValue& value : study.points[run.point].values) text += (text.empty() ? "" : ", ") + value.label;
    return fmt::format("{}{}{}, seed {}", text, text.empty() ? "" : ": ", title(run.test()), run.seed());
}

// Tells of a study while it runs: a line for every run that ends, with what is left.
class StudyProgress {
public:
    explicit StudyProgress(const Study& study, const Ledger& ledger) : study_(study) {
        std::vector<std::string> ids;
        for (const Run& run : study.runs) numbers_.emplace(run.id, 0);
        for (const auto& [id, number] : numbers_) ids.push_back(id);
        int number = 0;
        for (const Run& run : study.runs)
            if (numbers_[run.id] == 0) numbers_[run.id] = ++number;
        for (const RunRecord& record : ledger.find(ids)) ended_ += record.state == RunState::done;
        first_ = ended_;
        progress_.keep_log_short();
    }

    int runs() const { return static_cast<int>(numbers_.size()); }
    int done() const { return ended_; }

    void report(const Run& run, const TestProgress& progress) { progress_.report(numbers_[run.id], runs(), label_of(study_, run), progress); }

    void ended(const Run& run, const RunRecord& record) {
        ++ended_;
        progress_.ended(numbers_[run.id]);
        const std::string what = record.state == RunState::failed ? "failed: " + record.reason : result_text(record);
        progress_.note(fmt::format("{}/{} {}: {}{}", ended_, runs(), label_of(study_, run), what, left()));
    }

    void note(const std::string& line) { progress_.note(line); }
    void clear() { progress_.clear(); }

private:
    static std::string result_text(const RunRecord& record) {
        return fmt::format("{:.4g} MPa, grade {}, {}", record.numbers.at("strength_Pa") / 1e6, record.texts.at("grade"),
                           duration_text(record.numbers.at("wall_s")));
    }

    // The rest, at the pace of this call so far.
    std::string left() const {
        const int rest = runs() - ended_;
        if (rest <= 0) return {};
        const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        return fmt::format("; about {} left", duration_text(passed / (ended_ - first_) * rest));
    }

    const Study& study_;
    std::map<std::string, int> numbers_;   // of each run, from 1 on
    int ended_ = 0, first_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    Progress progress_;
};

int threads_for(const StudyOptions& options) {
    Job job;
    job.threads = options.threads.value_or(0);
    return thread_count(job);
}

ExitCode outcome(const Execution& execution) {
    if (execution.left > 0) return ExitCode::interrupted;
    return execution.failed > 0 ? ExitCode::numerical : ExitCode::success;
}

}  // namespace

Study study_with_options(const StudyOptions& options) {
    Study study = read_study(options.study);
    if (options.results) study.results = *options.results;
    return study;
}

ExitCode study_command(const StudyOptions& options) {
    install_signal_handlers();
    const Study study = study_with_options(options);
    if (options.on == "slurm") return study_on_slurm(study, options);
    Ledger ledger(study.results, Ledger::Access::write);
    ledger.enrol(study);
    StudyProgress progress(study, ledger);
    progress.note(fmt::format("{}: {} runs at {} point{}, {} done already; results in {}", study.name, progress.runs(), study.points.size(),
                              study.points.size() == 1 ? "" : "s", progress.done(), study.results.string()));
    ExecuteControl control;
    control.threads = threads_for(options);
    control.at_once = options.at_once.value_or(0);
    control.keep = study.keep;
    control.stop = &stop_requested();
    control.provenance = collect_provenance(options.command_line, control.threads);
    control.progress = [&](const Run& run, const TestProgress& state) { progress.report(run, state); };
    control.ended = [&](const Run& run, const RunRecord& record) { progress.ended(run, record); };
    control.note = [&](const std::string& line) { progress.note(line); };
    const Execution execution = execute(study.runs, ledger, control);
    progress.clear();

    fmt::print("\n{}\n", study_text(study, point_results(study, ledger)));
    fmt::print("{} runs done now, {} before, {} failed; {} of runs in {}\n", execution.done, execution.found_done, execution.failed,
               duration_text(execution.run_s), duration_text(execution.wall_s));
    fmt::print("Ledger: {}\n", (study.results / "ledger.sqlite").string());
    if (execution.left > 0) fmt::print(stderr, "interrupted with {} runs left; the same command goes on with them\n", execution.left);
    return outcome(execution);
}

ExitCode study_status_command(const StudyOptions& options) {
    const Study study = study_with_options(options);
    std::map<RunState, std::vector<RunRecord>> by_state;
    std::vector<std::string> ids;
    std::map<std::string, const Run*> runs;
    for (const Run& run : study.runs)
        if (runs.emplace(run.id, &run).second) ids.push_back(run.id);
    if (std::filesystem::exists(study.results / "ledger.sqlite"))
        for (RunRecord& record : Ledger(study.results, Ledger::Access::read).find(ids)) by_state[record.state].push_back(std::move(record));
    const auto count = [&](RunState state) { return by_state[state].size(); };
    fmt::print("{}: {} points, {} runs: {} done, {} running, {} failed, {} to do\n", study.name, study.points.size(), ids.size(),
               count(RunState::done), count(RunState::running), count(RunState::failed),
               ids.size() - count(RunState::done) - count(RunState::running) - count(RunState::failed));
    double spent_s = 0.0;
    for (const RunRecord& record : by_state[RunState::done]) spent_s += record.numbers.at("wall_s");
    fmt::print("Time of the runs that are done: {}\n", duration_text(spent_s));
    for (const RunRecord& record : by_state[RunState::failed]) fmt::print("failed: {}: {}\n", label_of(study, *runs.at(record.id)), record.reason);
    for (const RunRecord& record : by_state[RunState::running]) fmt::print("running, or left behind: {}\n", label_of(study, *runs.at(record.id)));
    print_slurm_status(study.results);
    return ExitCode::success;
}

ExitCode study_table_command(const StudyOptions& options) {
    const Study study = study_with_options(options);
    const Ledger ledger(study.results, Ledger::Access::read);
    const std::string text = options.runs ? runs_csv(study, ledger) : points_csv(study, point_results(study, ledger));
    fmt::print("{}", text);
    return ExitCode::success;
}

}  // namespace feldspar
