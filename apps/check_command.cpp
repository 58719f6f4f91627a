#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "campaign.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace feldspar {
namespace {

void print_specimen(const char* what, const Specimen& specimen) {
    const SpecimenQuality& q = specimen.quality;
    fmt::print("{} (seed {})\n", what, specimen.seed);
    fmt::print("  grains                {}\n", q.grains);
    fmt::print("  contacts              {}\n", q.contacts);
    fmt::print("  nodes, triangles      {}, {}\n", q.nodes, q.triangles);
    fmt::print("  vertices per grain    {:.2f}\n", q.vertices_per_grain);
    fmt::print("  merged edges          {}\n", q.merged_edges);
    fmt::print("  smallest edge         {:.4f} mm\n", 1e3 * q.smallest_edge_m);
    fmt::print("  smallest triangle     {:.6f} mm2, {:.4f} mm high\n", 1e6 * q.smallest_triangle_m2,
               1e3 * q.smallest_triangle_height_m);
    fmt::print("  overlap of the discs  {:.2f} % of the mean diameter on average, {:.2f} % at most\n", 100.0 * q.overlap_mean,
               100.0 * q.overlap_max);
    fmt::print("  width / largest grain {:.1f}\n", q.width_over_largest_grain);
    fmt::print("  area error            {:.1e}\n", q.area_error);
    for (const std::string& warning : q.warnings) fmt::print("  warning: {}\n", warning);
}

std::string memory_text(double bytes) {
    return bytes < 1e9 ? fmt::format("{:.1f} MB", bytes / 1e6) : fmt::format("{:.2f} GB", bytes / 1e9);
}

}  // namespace

ExitCode check_command(const JobOptions& options) {
    install_signal_handlers();
    const Job job = job_with_options(options);
    const int threads = thread_count(job);
    const std::vector<PlannedRun> runs = planned_runs(job);
    Progress progress;
    Specimens specimens(job);

    std::map<const TestSpec*, int> count;           // runs of each test
    std::map<const TestSpec*, PlannedRun> example;  // the first of them stands for all
    bool has_rectangle = false, has_disc = false;
    for (const PlannedRun& run : runs) {
        ++count[run.test];
        example.emplace(run.test, run);
    }
    fmt::print("Job {} is sound: {} runs of {} tests, {} thread{}\n\n", job.name, runs.size(), job.tests.size(), threads,
               threads == 1 ? "" : "s");

    double total_s = 0.0;
    std::string tests;
    for (const TestSpec& test : job.tests) {
        if (stop_requested()) throw Interrupted();
        const PlannedRun& run = example.at(&test);
        progress.busy(fmt::format("building {}, seed {}", title(test), run.seed));
        const std::shared_ptr<const Specimen> specimen = specimens.get(run);
        RunControl control;
        control.threads = threads;
        control.stop = &stop_requested();
        const TestPreview preview = preview_test(setup_of(job, run, specimen), control);
        progress.clear();
        bool& shown = test.kind == TestKind::brazilian ? has_disc : has_rectangle;
        if (!shown) print_specimen(test.kind == TestKind::brazilian ? "Disc of the Brazilian test" : "Specimen", *specimen);
        shown = true;
        total_s += preview.expected_seconds * count.at(&test);
        tests += fmt::format("{} x {}\n", count.at(&test), title(test));
        tests += fmt::format("  contact points        {}\n", preview.contact_points);
        tests += fmt::format("  memory                {}\n", memory_text(preview.memory_bytes));
        tests +=
            fmt::format("  stability             (omega dt)^2 = {:.3f}, limit {:.3f}\n", preview.omega2, preview.omega2_limit);
        tests += fmt::format("  stable time step      {:.3e} s with real masses\n", preview.stable_time_step_s);
        tests += fmt::format("  expected, each        about {:.0f} steps, {}\n", preview.expected_steps,
                             duration_text(preview.expected_seconds));
    }
    fmt::print("\n{}\nExpected time of the whole job: about {}. Nothing was run, no file was written.\n", tests,
               duration_text(total_s));
    return ExitCode::success;
}

}  // namespace feldspar
