// `feldspar study --on slurm`, and what runs on the cluster in its name.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "commands.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/slurm.hpp"
#include "feldspar/study/study_table.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "say.hpp"
#include "terminal.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

std::string what_runs(const RunRecord& record) {
    const std::string confined = record.sigma3_Pa != 0.0 ? fmt::format(" at {:.6g} MPa", record.sigma3_Pa / 1e6) : "";
    return fmt::format("{}{}, seed {} (run {})", record.test, confined, record.seed, record.id);
}

void print_gathering(const Gathering& gathering) {
    for (const RunRecord& record : gathering.failed) say("failed: {}: {}\n", what_runs(record), record.reason);
    for (const LostElement& lost : gathering.lost)
        say("not done: {} of element {}: {}\n  its output: {}\n", counted(lost.runs.size(), "run"), lost.job, lost.reason,
            lost.output.string());
    say("{} taken into the ledger, {} in the queue, {} failed, {} not done\n", counted(gathering.taken, "run"), gathering.queued,
        gathering.failed.size(), gathering.missing());
}

ExitCode outcome(const Gathering& gathering) {
    return gathering.failed.empty() && gathering.lost.empty() ? ExitCode::success : ExitCode::numerical;
}

void print_submission(const Submission& submission, const std::string& study) {
    if (submission.queued > 0) say("{} already in Slurm's queue\n", counted(submission.queued, "run"));
    if (submission.elsewhere > 0) say("{} left to another process of this machine\n", counted(submission.elsewhere, "run"));
    if (submission.failed > 0)
        say("{} failed before and not repeated; --retry-failed submits them again\n", counted(submission.failed, "run"));
    if (!submission.plan) {
        say("Nothing to submit: {} done\n", counted(submission.done, "run"));
        return;
    }
    const SlurmPlan& plan = *submission.plan;
    say("Submitted {} (about {} on one thread) as {} of job {}; job {} takes the results in\n",
        counted(submission.submitted, "run"), duration_text(submission.expected_s), counted(plan.groups.size(), "element"),
        plan.array_job, plan.gather_job);
    say("Plan, scripts and output: {}\n", plan.directory.string());
    say("To follow: feldspar study status {}   or   squeue --jobs={},{}\nTo stop:   scancel {}\n", study, plan.array_job,
        plan.gather_job, plan.array_job);
}

// Waits so long, or until the user interrupts.
void wait(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (!stop_requested() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

std::string progress_text(const std::vector<ArrayState>& states) {
    ArrayState sum;
    for (const ArrayState& state : states) {
        sum.waiting += state.waiting;
        sum.running += state.running;
        sum.recorded += state.recorded;
        sum.runs += state.runs;
    }
    return fmt::format("{}/{} runs; elements: {} running, {} waiting", sum.recorded, sum.runs, sum.running, sum.waiting);
}

// Until no plan has anything in the queue; asks seldom, because everybody's jobs go through one queue.
void wait_for(const std::vector<SlurmPlan>& plans) {
    constexpr int patience = 10;  // failed questions in a row: the controller may be starting anew
    std::chrono::milliseconds pause(500);
    std::string told;
    Progress progress;
    for (int failures = 0; !stop_requested();) {
        try {
            const std::vector<ArrayState> states = array_states(plans);
            failures = 0;
            if (progress_text(states) != told) progress.note(told = progress_text(states));
            if (std::all_of(states.begin(), states.end(), [](const ArrayState& state) { return state.over; })) break;
        } catch (const InputError&) {
            if (++failures == patience) throw;
        }
        wait(pause);
        pause = std::min(pause * 3 / 2, std::chrono::milliseconds(30'000));
    }
    progress.clear();
}

std::vector<SlurmPlan> plans_in_queue(const fs::path& results) {
    std::vector<SlurmPlan> plans = read_plans(results);
    std::erase_if(plans, [](const SlurmPlan& plan) { return plan.array_job.empty(); });
    if (plans.empty()) return plans;
    const std::vector<ArrayState> states = array_states(plans);
    std::vector<SlurmPlan> queued;
    for (std::size_t i = 0; i < plans.size(); ++i)
        if (!states[i].over) queued.push_back(plans[i]);
    return queued;
}

}  // namespace

ExitCode study_on_slurm(const Study& study, const StudyOptions& options) {
    require_slurm();
    Ledger ledger(study.results, Ledger::Access::write);
    const Submission submission = submit(study, ledger, options.slurm, fs::read_symlink("/proc/self/exe"), options.retry_failed);
    print_submission(submission, options.study);
    if (!options.wait) return ExitCode::success;
    std::fflush(stdout);
    wait_for(plans_in_queue(study.results));
    if (stop_requested()) {
        say(stderr, "no longer waiting; the runs stay in the queue\n");
        return ExitCode::interrupted;
    }
    const Gathering gathering = gather(ledger);  // again, should the gathering job have failed
    say("\n{}\n", study_text(study, point_results(study, ledger), output_columns()));
    print_gathering(gathering);
    return outcome(gathering);
}

ExitCode study_gather_command(const StudyOptions& options) {
    const fs::path results = fs::is_directory(options.study) ? fs::path(options.study) : study_with_options(options).results;
    if (read_plans(results).empty())
        throw InputError({}, fmt::format("nothing of '{}' has gone to Slurm", results.string()),
                         "feldspar study STUDY.toml --on slurm");
    Ledger ledger(results, Ledger::Access::write);
    const Gathering gathering = gather(ledger);
    print_gathering(gathering);
    return outcome(gathering);
}

ExitCode study_element_command(const ElementOptions& options) {
    install_signal_handlers();
    const SlurmPlan plan = read_plan(options.plan);
    ExecuteControl control;
    control.threads = plan.cpus;
    control.stop = &stop_requested();
    control.checkpoints = checkpoint_settings();
    control.provenance = collect_provenance(options.command_line, control.threads);
    Progress progress;
    control.ended = [&](const Run&, const RunRecord& record) {
        progress.note(record.state == RunState::failed
                          ? fmt::format("failed: {}: {}", what_runs(record), record.reason)
                          : fmt::format("done: {} in {}", what_runs(record), duration_text(record.numbers.at("wall_s"))));
    };
    const Execution execution = run_element(plan, options.group, control);
    progress.note(fmt::format("element {}: {} done now, {} before, {} failed, {} left", options.group, execution.done,
                              execution.found_done, execution.failed, execution.left));
    if (execution.left > 0) return ExitCode::interrupted;
    return execution.failed > 0 ? ExitCode::numerical : ExitCode::success;
}

void print_slurm_status(const fs::path& results) {
    try {
        const std::vector<SlurmPlan> plans = plans_in_queue(results);
        const std::vector<ArrayState> states = plans.empty() ? std::vector<ArrayState>{} : array_states(plans);
        for (std::size_t i = 0; i < plans.size(); ++i) say("Slurm job {}: {}\n", plans[i].array_job, progress_text({states[i]}));
    } catch (const InputError& problem) {
        say("{}\n", problem.what());
    }
}

}  // namespace feldspar
