#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "commands.hpp"
#include "device_option.hpp"
#include "feldspar/base/angle.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/base/thread_shares.hpp"
#include "feldspar/lab/on_device.hpp"
#include "feldspar/methods/flattened_disc.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/study/packings.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "feldspar/study/sharing.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

// The grains are the cells, which fill the outline: larger than the discs that were asked for, which leave pores.
std::string sizes_text(const SizeSummary& sizes, double unit_m) {
    return fmt::format("mean {:.3g}, {:.3g} to {:.3g}, D50 {:.3g}", sizes.mean_m / unit_m, sizes.minimum_m / unit_m,
                       sizes.maximum_m / unit_m, sizes.D50_m / unit_m);
}

void print_specimen(const Printing& print, const std::string& what, const Specimen& specimen) {
    const SpecimenQuality& q = specimen.quality;
    const bool metres = q.cell_sizes.mean_m >= 0.1;  // blocks of a slope
    const double unit_m = metres ? 1.0 : 1e-3;
    const char* const unit = metres ? "m" : "mm";
    print.say_results("{} (seed {})\n", what, specimen.seed);
    print.say_results("  grains                {}\n", q.grains);
    print.say_results("  contacts              {}\n", q.contacts);
    print.say_results("  nodes, triangles      {}, {}\n", q.nodes, q.triangles);
    print.say_results("  vertices per grain    {:.2f}\n", q.vertices_per_grain);
    print.say_results("  merged edges          {}\n", q.merged_edges);
    print.say_results("  smallest edge         {:.4f} {}\n", q.smallest_edge_m / unit_m, unit);
    print.say_results("  smallest triangle     {:.6f} {}2, {:.4f} {} high\n", q.smallest_triangle_m2 / (unit_m * unit_m), unit,
                      q.smallest_triangle_height_m / unit_m, unit);
    if (specimen.spec.given_cells.given())
        print.say_results("  corners of the file   {} welded, {} put into edges, {} moved onto the outline\n", q.welded,
                          q.inserted, q.moved);
    else
        print.say_results("  overlap of the discs  {:.2f} % of the mean diameter on average, {:.2f} % at most\n",
                          100.0 * q.overlap_mean, 100.0 * q.overlap_max);
    print.say_results("  {:<22}{}\n", fmt::format("grain sizes, {}", unit), sizes_text(q.cell_sizes, unit_m));
    if (!specimen.spec.given_cells.given())
        print.say_results("  {:<22}{}\n", fmt::format("discs asked for, {}", unit), sizes_text(q.disc_sizes, unit_m));
    const std::vector<PhaseFill> fills = fill_of_phases(specimen);
    for (std::size_t p = 0; p < fills.size(); ++p)
        print.say_results("  {:<22}{} grains, {:.2f} % of the area ({:.4g} % asked for), {}: {}; discs {}\n",
                          specimen.packing.phase_names[p], fills[p].grains, 100.0 * fills[p].area_share,
                          100.0 * specimen.spec.phase_sizes[p].share, unit, sizes_text(fills[p].cells, unit_m),
                          sizes_text(fills[p].discs, unit_m));
    if (q.crossings > 0)
        print.say_results(
            "  cuts that cross       {} crossings, or ends on another cut; {} pieces were too small for a grain and went to a "
            "neighbour\n",
            q.crossings, q.joined_pieces);
    print.say_results("  hexatic order         {:.2f}, size spread {:.1f} %\n", q.hexatic_order, 100.0 * q.size_spread);
    print.say_results("  width / largest grain {:.1f}\n", q.width_over_largest_grain);
    print.say_results("  area error            {:.1e}\n", q.area_error);
    for (const std::string& warning : q.warnings) print.say_results("  warning: {}\n", warning);
}

// What presses on the flats decides how much of 2P / (pi D t) counts.
std::string flats_text(const PlannedRun& run, const Specimen& specimen) {
    if (!method_of(*run.test).specimen.own_disc || !specimen.outline.flattened()) return {};
    const double angle = specimen.spec.outline.flat_angle_rad, R = specimen.outline.radius_m;
    const Variant& v = *run.variant;
    return fmt::format(
        "  flats of the disc     {:.4g} degrees, {:.3g} mm wide, {:.3g} mm apart; stress = k 2P / (pi D t), k = {:.4f}\n",
        in_degrees(angle), 2e3 * R * std::sin(0.5 * angle), 2e3 * specimen.outline.flat_height_m,
        flat_coefficient(specimen, v.model, v.grain, v.contact, *run.test));
}

std::string memory_text(double bytes) {
    return bytes < 1e9 ? fmt::format("{:.1f} MB", bytes / 1e6) : fmt::format("{:.2f} GB", bytes / 1e9);
}

// One number where its bounds hardly differ.
std::string memory_text(const Foreseen& bytes) {
    constexpr double kSame = 1.05;
    if (bytes.high < kSame * bytes.low) return memory_text(bytes.usual);
    return fmt::format("{} to {}, the more the more steps it takes", memory_text(bytes.low), memory_text(bytes.high));
}

// Two digits: more are not known.
double rounded_steps(double steps) {
    const double unit = steps > 0.0 ? std::pow(10.0, std::floor(std::log10(steps)) - 1.0) : 1.0;
    return std::round(steps / unit) * unit;
}

std::string course_text(const TestPreview& preview) {
    const Foreseen& steps = preview.steps;
    if (!(steps.high > steps.usual))  // the job's own limit
        return fmt::format("{:.0f} steps, {}", steps.usual, duration_text(preview.step_seconds * steps.usual));
    return fmt::format("about {:.0f} steps, {}; nine tests in ten take {:.0f} to {:.0f}, {} to {}", rounded_steps(steps.usual),
                       duration_text(preview.step_seconds * steps.usual), rounded_steps(steps.low), rounded_steps(steps.high),
                       duration_text(preview.step_seconds * steps.low), duration_text(preview.step_seconds * steps.high));
}

// What the runs of one variant and test have in common.
struct Group {
    PlannedRun example;  // the first of them stands for all
    int runs = 0;
};

// One group for each variant and test, in the order of the job.
std::vector<Group> groups_of(const Job& job) {
    std::map<std::pair<const Variant*, const TestSpec*>, Group> found;
    for (const PlannedRun& run : planned_runs(job)) {
        Group& group = found[{run.variant, run.test}];
        if (group.runs++ == 0) group.example = run;
    }
    std::vector<Group> groups;
    for (const auto& [key, group] : found) groups.push_back(group);  // both pointers grow with the job's lists
    return groups;
}

std::string preview_text(const TestPreview& preview) {
    std::string text = fmt::format("  contact points        {}\n", preview.contact_points);
    text += fmt::format("  memory                {}\n", memory_text(preview.memory_bytes));
    text += fmt::format("  stability             (omega dt)^2 = {:.3f}, limit {:.3f}\n", preview.omega2, preview.omega2_limit);
    text += fmt::format("  stable time step      {:.3e} s with real masses\n", preview.stable_time_step_s);
    return text;
}

std::string variant_text(const Variant& variant) {
    std::string text =
        fmt::format("{}\n  model                 {} grains, contact {}, normal {}, {} law\n", variant.name,
                    name(variant.model.kind), name(variant.model.contact), name(variant.model.normal), name(variant.contact.law));
    text += fmt::format("  Kn, eta               {:.4g} GPa/m, {:.4g}\n", variant.contact.Kn_Pa_m / 1e9, variant.contact.eta);
    return text;
}

// Builds one run of each group and prints what comes out: of a variant the model and its first test in full, of its other
// tests the steps and the time.
class Check {
public:
    /// @param warned  gets what is to be said of specimens, too
    Check(const Job& job, int threads, DeviceUse device, const Printing& print, std::vector<std::string>& warned)
        : job_(job),
          print_(print),
          warned_(warned),
          device_(std::move(device)),
          packings_(planned_runs(job).size(), &stop_requested()),
          threads_(threads),
          sharing_(job.at_once, threads) {
        control_.stop = &stop_requested();
    }

    /// @return what is foreseen, for programs
    Json run() {
        for (const Group& group : groups_of(job_)) {
            if (stop_requested()) throw Interrupted();
            add(group);
        }
        print_.say_results("\n{}\nExpected time of the whole job: about {} ({} to {}). Nothing was run, no file was written.\n",
                           text_, duration_text(total_s_.usual), duration_text(total_s_.low), duration_text(total_s_.high));
        return {{"tests", tests_}, {"seconds", range_json(total_s_, 1.0)}};
    }

private:
    static Json range_json(const Foreseen& range, double factor) {
        return {{"low", factor * range.low}, {"usual", factor * range.usual}, {"high", factor * range.high}};
    }

    void tell(const Group& group, const TestPreview& preview) {
        const PlannedRun& run = group.example;
        tests_.push_back({{"variant", run.variant->name},
                          {"test", title(*run.test)},
                          {"runs", group.runs},
                          {"grains", preview.grains},
                          {"contacts", preview.contacts},
                          {"contact_points", preview.contact_points},
                          {"nodes", preview.nodes},
                          {"triangles", preview.triangles},
                          {"memory_MB", range_json(preview.memory_bytes, 1e-6)},
                          {"steps", range_json(preview.steps, 1.0)},
                          {"seconds", range_json(preview.steps, preview.step_seconds)},
                          {"omega2", preview.omega2},
                          {"omega2_limit", preview.omega2_limit},
                          {"stable_time_step_s", preview.stable_time_step_s}});
    }

    void add(const Group& group) {
        const PlannedRun& run = group.example;
        const std::shared_ptr<const Specimen> specimen =
            packings_.get(specimen_of(run), run.seed, threads_, [&](const SpecimenProgress& state) {
                if (!print_.quiet()) progress_.making(packing_stem(run), state);
            });
        if (!print_.quiet()) progress_.busy("building " + label_of(run));
        // timed with the threads that it will have beside the others; what these would take of its speed is not seen
        const int bodies = body_count(run, *specimen);
        const int at_once = std::min(sharing_.most_at_once(bodies), static_cast<int>(planned_runs(job_).size()));
        control_.threads = share_for_next(threads_, at_once, sharing_.useful_threads(bodies));
        const TestSetup setup = setup_of(run, specimen);
        std::string card;
        if (device_.open && opener_for(setup, device_, [&](const std::string& line) { card = "  " + line + "\n"; }))
            card = fmt::format("  memory of the card    {}\n", memory_text(card_needs(setup, control_).bytes));
        const TestPreview preview = preview_test(setup, control_);
        progress_.clear();
        show_specimen(*run.test, *specimen);
        const bool first = std::exchange(variant_, run.variant) != run.variant;
        if (first && job_.has_variants()) text_ += (text_.empty() ? "" : "\n") + variant_text(*run.variant);
        if (job_.has_variants()) {
            if (first) text_ += preview_text(preview);
            text_ += flats_text(run, *specimen) + card;
            text_ += fmt::format("  {} x {}: {} each\n", group.runs, title(*run.test), course_text(preview));
        } else {
            text_ += fmt::format("{} x {}\n{}", group.runs, title(*run.test), preview_text(preview));
            text_ += flats_text(run, *specimen) + card;
            text_ += fmt::format("  expected, each        {}\n", course_text(preview));
        }
        tell(group, preview);
        const double each_s = preview.step_seconds * group.runs / at_once;
        total_s_.low += preview.steps.low * each_s;
        total_s_.usual += preview.steps.usual * each_s;
        total_s_.high += preview.steps.high * each_s;
    }

    void show_specimen(const TestSpec& test, const Specimen& specimen) {
        const std::string head = method_of(test).specimen.own_disc ? fmt::format("Disc of the {}", method_of(test).words.title)
                                 : test.specimen                   ? fmt::format("Specimen of {}", title(test))
                                                                   : "Specimen";
        if (!shown_.insert(head).second) return;
        print_specimen(print_, head, specimen);
        for (const std::string& warning : specimen.quality.warnings) {
            warned_.push_back(fmt::format("{} (seed {}): {}", head, specimen.seed, warning));
            if (print_.quiet()) say(stderr, "warning: {}\n", warned_.back());
        }
    }

    const Job& job_;
    const Printing& print_;
    std::vector<std::string>& warned_;
    DeviceUse device_;
    Packings packings_;
    int threads_;
    Sharing sharing_;
    Progress progress_;
    RunControl control_;
    const Variant* variant_ = nullptr;  // the last one shown
    std::set<std::string> shown_;       // headings of specimens
    Foreseen total_s_;
    Json tests_ = Json::array();
    std::string text_;
};

}  // namespace

ExitCode check_command(const CheckOptions& options) {
    install_signal_handlers();
    return printing(options.print, [&](Printing& print) {
        const Job job = job_with_options(options);
        const int threads = thread_count(job.threads);
        print.say_results("Job {} is sound: {} of {}{}, {}\n\n", job.name, counted(planned_runs(job).size(), "run"),
                          counted(job.tests.size(), "test"),
                          job.has_variants() ? " and " + counted(job.variants.size(), "variant") : "",
                          counted(threads, "thread"));
        std::vector<std::string> warned = warnings(job);
        for (const std::string& warning : warned)
            say(print.quiet() ? stderr : print.results(), "warning: {}\n{}", warning, print.quiet() ? "" : "\n");
        Provenance provenance;
        const Json found = Check(job, threads, device_use(options.device, provenance), print, warned).run();
        if (!print.json()) return ExitCode::success;
        Json object = {{"job", job.name}, {"runs", planned_runs(job).size()}, {"threads", threads}, {"warnings", warned}};
        for (const auto& [key, value] : found.items()) object[key] = value;
        print.print_object(object);
        return ExitCode::success;
    });
}

}  // namespace feldspar
