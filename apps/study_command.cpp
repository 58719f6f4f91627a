#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/study_report.hpp"
#include "feldspar/study/study_table.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "running_study.hpp"
#include "say.hpp"

namespace feldspar {
Study study_with_options(const StudyOptions& options) {
    Study study = read_study(options.study, options.settings);
    if (options.results) study.results = *options.results;
    return study;
}

namespace {

ExitCode run_and_print(const StudyOptions& options, Printing& print) {
    const Study study = study_with_options(options);
    if (options.on == "slurm" && options.device != "cpu")
        throw InputError({.key = "--device"}, "elements of a job array run on processors", "cpu",
                         "run the study on a machine with a card, without --on slurm");
    if (options.on == "slurm") return study_on_slurm(study, options);
    LiveView live(options.live, study.name, words_of("study"));
    Ledger ledger(study.results, Ledger::Access::write);
    if (!options.settings.empty() && !print.quiet())
        say(stderr,
            "what --set changes makes other runs: those of the file as it stands stay in the ledger, and the page shows these\n");
    const Execution execution = run_study(study, ledger,
                                          {thread_count(options.threads.value_or(0)), options.at_once.value_or(0),
                                           options.command_line, options.device, options.retry_failed, /*shows_points=*/true},
                                          print, live);

    const std::vector<PointResults> points = point_results(study, ledger);
    write_study_report(study, points, study_page(study));
    print.say_results("\n{}\n", study_text(study, points, print.columns()));
    print_execution(study, execution, print);
    print.say_results("Page: {}\n", study_page(study).string());
    print.end(study.results, [&] {
        Json object = execution_json(study, execution, study_page(study));
        const Json found = Json::parse(study_json(study, points));
        for (const auto& [key, value] : found.items()) object[key] = value;
        return object;
    });
    end_live(live, "study", execution, study_page(study));
    return outcome(execution);
}

}  // namespace

ExitCode study_command(const StudyOptions& options) {
    install_signal_handlers();
    return printing(options.print, [&](Printing& print) { return run_and_print(options, print); });
}

ExitCode study_status_command(const StudyOptions& options) {
    const Study study = study_with_options(options);
    std::map<RunState, std::vector<RunRecord>> by_state;
    std::vector<std::string> ids;
    std::map<std::string, const Run*> runs;
    for (const Run& run : study.runs)
        if (runs.emplace(run.id, &run).second) ids.push_back(run.id);
    if (std::filesystem::exists(study.results / "ledger.sqlite"))
        for (RunRecord& record : Ledger(study.results, Ledger::Access::read).find(ids))
            by_state[record.state].push_back(std::move(record));
    const auto count = [&](RunState state) { return by_state[state].size(); };
    say("{}: {} points, {} runs: {} done, {} running, {} failed, {} to do\n", study.name, study.points.size(), ids.size(),
        count(RunState::done), count(RunState::running), count(RunState::failed),
        ids.size() - count(RunState::done) - count(RunState::running) - count(RunState::failed));
    double spent_s = 0.0;
    for (const RunRecord& record : by_state[RunState::done]) spent_s += record.numbers.at("wall_s");
    say("Time of the runs that are done: {}\n", duration_text(spent_s));
    for (const RunRecord& record : by_state[RunState::failed])
        say("failed: {}: {}\n", label_of(study, *runs.at(record.id)), record.reason);
    const Provenance here = collect_provenance({}, 1);
    const std::size_t kept = settled_runs(by_state[RunState::failed], &here).failed.size();
    if (kept > 0) say("{} of the failed runs will not be repeated, but by --retry-failed\n", kept);
    for (const RunRecord& record : by_state[RunState::running])
        say("running, or left behind: {}\n", label_of(study, *runs.at(record.id)));
    print_slurm_status(study.results);
    return ExitCode::success;
}

ExitCode study_table_command(const StudyOptions& options) {
    const Study study = study_with_options(options);
    const Ledger ledger(study.results, Ledger::Access::read);
    const std::string text = options.runs ? runs_csv(study, ledger) : points_csv(study, point_results(study, ledger));
    say("{}", text);
    return ExitCode::success;
}

}  // namespace feldspar
