#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/findings/converge.hpp"
#include "interrupt.hpp"
#include "running_study.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

double limit(const std::string& text) {
    double value = 0.0;
    try {
        value = parse_quantity(text, Dimension::fraction);
    } catch (const InputError& error) {
        throw InputError({{}, 0, 0, "--within"}, error.problem(), error.allowed(), error.suggestion());
    }
    if (!(value > 0.0 && value < 1.0))
        throw InputError({{}, 0, 0, "--within"}, fmt::format("'{}' is no change that does not matter", text),
                         "more than 0 and less than 100 %");
    return value;
}

ExitCode run_and_print(const ConvergeCommandOptions& options, Printing& print) {
    JobOptions whole = options;
    whole.tests.clear();  // the plan chooses
    const Job job = job_with_options(whole);
    const ConvergePlan plan =
        plan_convergence(job, {options.packings, full_kinds(options.tests), limit(options.within), options.results});
    for (const std::string& remark : plan.remarks) say(stderr, "{}\n", remark);
    LiveView live(options.live, plan.study.name, words_of("convergence"));
    Ledger ledger(plan.study.results, Ledger::Access::write);
    const StudyRunning running{thread_count(job.threads), job.at_once, options.command_line, options.device,
                               options.retry_failed};
    const Execution execution = run_study(plan.study, ledger, running, print, live);

    const std::vector<PointResults> points = point_results(plan.study, ledger);
    write_convergence(plan.study.results, plan, points, collect_provenance(options.command_line, running.threads));
    print.say_results("\n{}\n", convergence_text(plan, points, print.columns()));
    const std::filesystem::path page = plan.study.results / "converge.html";
    print_execution(plan.study, execution, print);
    print.say_results("Page: {}\n", page.string());
    print.end(plan.study.results,
              [&] { return with_file(execution_json(plan.study, execution, page), plan.study.results / "converge.json"); });
    end_live(live, "convergence", execution, page);
    return outcome(execution);
}

}  // namespace

ExitCode converge_command(const ConvergeCommandOptions& options) {
    install_signal_handlers();
    return printing(options.print, [&](Printing& print) { return run_and_print(options, print); });
}

}  // namespace feldspar
