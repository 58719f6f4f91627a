#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/findings/envelope.hpp"
#include "interrupt.hpp"
#include "running_study.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

std::vector<double> stresses(const std::vector<std::string>& given) {
    std::vector<double> values;
    for (const std::string& text : given) {
        double value = 0.0;
        try {
            value = parse_quantity(text, Dimension::stress);
        } catch (const InputError& error) {
            throw InputError({{}, 0, 0, "--sigma3"}, error.problem(), error.allowed(), error.suggestion());
        }
        if (value <= 0.0)
            throw InputError({{}, 0, 0, "--sigma3"}, fmt::format("'{}' confines nothing", text),
                             "stresses greater than zero; the uniaxial test is always there");
        values.push_back(value);
    }
    return values;
}

ExitCode run_and_print(const EnvelopeCommandOptions& options, Printing& print) {
    const Job job = job_with_options(options);
    const EnvelopePlan plan =
        plan_envelope(job, {options.packings, stresses(options.sigma3), options.with_tension, options.results});
    for (const std::string& remark : plan.remarks) say(stderr, "{}\n", remark);
    LiveView live(options.live, plan.study.name, words_of("envelope"));
    Ledger ledger(plan.study.results, Ledger::Access::write);
    const StudyRunning running{thread_count(job.threads), job.at_once, options.command_line, options.device,
                               options.retry_failed};
    const Execution execution = run_study(plan.study, ledger, running, print, live);

    const std::vector<PointResults> points = point_results(plan.study, ledger);
    write_envelope(plan.study.results, plan.study, points, options.with_tension,
                   collect_provenance(options.command_line, running.threads));
    print.say_results("\n{}\n", envelope_text(plan.study, points, options.with_tension, print.columns()));
    const std::filesystem::path page = plan.study.results / "envelope.html";
    print_execution(plan.study, execution, print);
    print.say_results("Page: {}\n", page.string());
    print.end(plan.study.results,
              [&] { return with_file(execution_json(plan.study, execution, page), plan.study.results / "envelope.json"); });
    end_live(live, "envelope", execution, page);
    return outcome(execution);
}

}  // namespace

ExitCode envelope_command(const EnvelopeCommandOptions& options) {
    install_signal_handlers();
    return printing(options.print, [&](Printing& print) { return run_and_print(options, print); });
}

}  // namespace feldspar
