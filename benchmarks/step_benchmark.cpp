// The program behind ./bench: what a step costs, stage by stage. docs/performance.md says how to read it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/calibration.hpp"
#include "benchmarks/calibration_record.hpp"
#include "benchmarks/cases.hpp"
#include "benchmarks/compare.hpp"
#include "benchmarks/granite.hpp"
#include "benchmarks/measure.hpp"
#include "benchmarks/report.hpp"
#include "benchmarks/table.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar::benchmarks {
namespace {

struct Options {
    bool full = false;
    bool list = false;
    std::string filter;
    std::vector<int> threads{1, 2};
    std::string out, compare;
    std::optional<double> fail_above_percent;
    std::string cache = FELDSPAR_BENCHMARK_CACHE;
    MeasureSettings measure;
};

void add_options(CLI::App& app, Options& options) {
    app.add_flag("--full", options.full, "every stage, state and size");
    app.add_option("--filter", options.filter, "only the cases whose name this regular expression finds")->type_name("REGEX");
    app.add_flag("--list", options.list, "print the names of the cases and stop");
    app.add_option("--threads", options.threads, "numbers of threads")->check(CLI::Range(1, 1024))->capture_default_str();
    app.add_option("--out", options.out, "write all readings to this file")->type_name("FILE.json");
    CLI::Option* compare =
        app.add_option("--compare", options.compare, "print ratios new/old to a file written with --out")->type_name("OLD.json");
    app.add_option("--fail-above", options.fail_above_percent,
                   "exit with 1 if an undisturbed case became slower by more than this")
        ->type_name("PERCENT")
        ->needs(compare);
    app.add_option("--blocks", options.measure.quiet.blocks, "undisturbed blocks that a reading needs")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--most-blocks", options.measure.most_blocks, "blocks after which a disturbed reading is given up")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_option("--quiet-share", options.measure.quiet.share, "how near the best calibration an undisturbed one must come")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--cache", options.cache, "folder in which packings and the best calibrations are kept")->type_name("DIR");
}

// Bytes that can be had without swapping; absent where the system does not say.
std::optional<double> available_memory() {
    std::ifstream input("/proc/meminfo");
    for (std::string line; std::getline(input, line);)
        if (line.starts_with("MemAvailable:")) return 1024.0 * std::stod(line.substr(13));
    return std::nullopt;
}

Machine described_machine() {
    Machine machine = this_machine();
    const Provenance provenance = collect_provenance("", 1);
    machine.compiler = provenance.compiler;
    machine.version = provenance.version;
    machine.commit = provenance.commit;
    machine.started = provenance.started;
    machine.build_type = FELDSPAR_BUILD_TYPE;
    return machine;
}

/// One team a number of threads: a team's threads go on spinning for a moment after their work, so only one may be alive.
class Teams {
public:
    Team& of(int threads) {
        if (!team_ || team_->size() != threads) {
            team_.reset();
            team_ = std::make_unique<Team>(threads);
        }
        return *team_;
    }

private:
    std::unique_ptr<Team> team_;
};

// The best calibration is looked for before anything is measured, so that the first readings already know what undisturbed is.
void look_for_best(Report& report, Teams& teams, const Options& options) {
    constexpr int kCalibrations = 25;
    for (const int threads : options.threads) {
        double& best = report.best[threads];
        for (int k = 0; k < kCalibrations; ++k)
            best = std::max(best, slowest_rates(teams.of(threads), options.measure.calibration_s).multiply_add);
        fmt::print(stderr, "calibration with {} thread{}: {:.1f} GFLOP/s a core\n", threads, threads == 1 ? "" : "s", best);
    }
}

Reading read(const Case& one, Granite& granite, Team& team, const MeasureSettings& settings, double& best) {
    Reading reading;
    reading.name = name(one);
    reading.stage = name(one.stage);
    reading.threads = one.threads;
    reading.counts = granite.counts();
    reading.blocks =
        measure([&](int steps) { granite.run(one.stage, team, steps); },
                [&] { return slowest_rates(team, settings.calibration_s); }, waited_seconds, one.threads, settings, best);
    return reading;
}

// The cases [begin, end), all of one specimen.
void run_on_specimen(const std::vector<Case>& cases, std::size_t begin, std::size_t end, const Options& options, Teams& teams,
                     Report& report) {
    const SpecimenChoice& specimen = cases[begin].specimen;
    if (const auto memory = available_memory(); memory && *memory < needed_memory(specimen)) {
        fmt::print(stderr, "left out: {} needs up to {:.1f} GB, and {:.1f} GB are free\n", name(specimen),
                   1e-9 * needed_memory(specimen), 1e-9 * *memory);
        return;
    }
    fmt::print(stderr, "building {} ...\n", name(specimen));
    Granite granite(specimen.grains, specimen.load, length_scale(specimen), options.cache);
    State state = State::elastic;  // as it was built
    for (std::size_t i = begin; i < end; ++i) {
        const Case& one = cases[i];
        if (one.state != state) granite.set(one.state);
        state = one.state;
        report.readings.push_back(read(one, granite, teams.of(one.threads), options.measure, report.best[one.threads]));
        const Summary summary = summarise(report.readings.back(), report.best, report.quiet);
        fmt::print(stderr, "[{}/{}] {}  {}{}\n", i + 1, cases.size(), name(one), time_text(summary.best_s),
                   summary.disturbed ? "  disturbed" : "");
    }
}

Report run(const std::vector<Case>& cases, const Options& options) {
    Report report;
    report.machine = described_machine();
    report.quiet = options.measure.quiet;
    Teams teams;
    look_for_best(report, teams, options);
    for (std::size_t begin = 0, end = 0; begin < cases.size(); begin = end) {
        while (end < cases.size() && cases[end].specimen == cases[begin].specimen) ++end;
        run_on_specimen(cases, begin, end, options, teams, report);
    }
    report.on_record =
        record_calibrations(std::filesystem::path(options.cache) / "calibrations.json", report.machine.processor, report.best);
    return report;
}

int report_on(const Options& options) {
    std::vector<Case> cases = make_cases(options.full, options.threads);
    if (!options.filter.empty()) cases = filtered(cases, options.filter);
    if (options.list) {
        for (const Case& one : cases) fmt::print("{}\n", name(one));
        return 0;
    }
    if (cases.empty()) {
        throw InputError({"", 0, 0, "--filter"}, fmt::format("no case has a name with '{}'", options.filter),
                         options.full ? "one of those that --list prints" : "one of those that --list prints; --full has more");
    }
    std::optional<Report> before;  // read first: a mistake shows before anything is measured
    if (!options.compare.empty()) before = read_report(options.compare);

    const Report report = run(cases, options);
    fmt::print("{}", report_table(report));
    if (options.full)
        for (const std::string& line : left_out()) fmt::print("Left out: {}.\n", line);
    if (!options.out.empty()) write_report(report, options.out);
    if (!before) return 0;

    const Comparison comparison = compare(*before, report);
    fmt::print("\nAgainst {} ({}, {}):\n{}", options.compare, before->machine.commit, before->machine.started,
               comparison_table(comparison));
    const auto worst = worst_slowdown_percent(comparison);
    return options.fail_above_percent && worst && *worst > *options.fail_above_percent ? 1 : 0;
}

}  // namespace
}  // namespace feldspar::benchmarks

int main(int argc, char** argv) {
    CLI::App app(
        "Measures what a step costs, stage by stage, with a calibration of the cores around every block (docs/performance.md).");
    feldspar::benchmarks::Options options;
    add_options(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        return report_on(options);
    } catch (const feldspar::InputError& error) {
        fmt::print(stderr, "step_benchmark: {}\n", error.what());
        return static_cast<int>(feldspar::ExitCode::input);
    } catch (const feldspar::OutputError& error) {
        fmt::print(stderr, "step_benchmark: {}\n", error.what());
        return static_cast<int>(feldspar::ExitCode::output);
    }
}
