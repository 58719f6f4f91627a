// The points at which a job is run again to see whether its answer stays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "feldspar/base/error.hpp"
#include "feldspar/findings/choose_seeds.hpp"
#include "feldspar/findings/converge.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {

namespace {

constexpr int usual_packings = 3;
constexpr double smallest_accuracy = 0.0005, largest_accuracy = 0.1;
constexpr double usual_paper_speed_m = 6.25e-9;
constexpr double least_width = 5.0,
                 good_width = 10.0;  ///< in largest grains: below the first a specimen is not one, below the second hardly

/// One more value of an axis: what it is called, and the job that has it.
struct Step {
    std::string label;
    double number;
    Job job;
};

struct Draft {
    std::string name, unit;
    bool same_packings;
    Step base;                // the job itself is not used
    std::vector<Step> steps;  // besides the base
};

// ---- sizes

void scale(GrainSizeSpec& sizes, double factor) {
    for (double* length : {&sizes.minimum_m, &sizes.maximum_m, &sizes.median_m}) *length *= factor;
    for (SievePoint& point : sizes.sieve) point.diameter_m *= factor;
}

double middle_diameter_m(const GrainSizeSpec& sizes) {
    if (sizes.kind == GrainSizeKind::uniform) return 0.5 * (sizes.minimum_m + sizes.maximum_m);
    if (sizes.kind == GrainSizeKind::log_normal) return sizes.median_m;
    for (std::size_t i = 1; i < sizes.sieve.size(); ++i) {
        const SievePoint &under = sizes.sieve[i - 1], &over = sizes.sieve[i];
        if (over.passing >= 0.5)
            return under.diameter_m +
                   (0.5 - under.passing) / (over.passing - under.passing) * (over.diameter_m - under.diameter_m);
    }
    return sizes.sieve.back().diameter_m;
}

double coarsest_m(const GrainSizeSpec& sizes) {
    return sizes.kind == GrainSizeKind::sieve ? sizes.sieve.back().diameter_m : sizes.maximum_m;
}

double width_m(const OutlineSpec& outline) {
    const Box box = bounding_box(outline);
    return box.upper.x - box.lower.x;
}

// Whose size stands for that of all: the first test's that takes the job's specimen, else the first test's.
const SpecimenSpec& leading_specimen(const Job& job) {
    const auto takes_it = [](const TestSpec& test) { return !test.specimen; };
    return job.tests.empty() || std::ranges::any_of(job.tests, takes_it) ? job.specimen : specimen_of(job, job.tests.front());
}

/// Width of the narrowest specimen over its largest grain.
double grains_across(const Job& job) {
    const auto across = [](const SpecimenSpec& s) { return width_m(s.outline) / coarsest_m(s.grain_sizes); };
    double least = std::numeric_limits<double>::infinity();
    for (const TestSpec& test : job.tests) least = std::min(least, across(specimen_of(job, test)));
    return least;
}

template <class Change>
Job changed(const Job& job, const Change& change) {
    Job other = job;
    for_each_specimen(other, change);
    return other;
}

Step grain_step(const Job& job, double factor) {
    const double diameter_mm = 1e3 * middle_diameter_m(job.specimen.grain_sizes) * factor;
    return {fmt::format("{:.4g} mm", diameter_mm), diameter_mm, changed(job, [factor](SpecimenSpec& s) {
                scale(s.grain_sizes, factor);
                for (PhaseSizes& phase : s.phase_sizes) scale(phase.sizes, factor);
                if (s.merge_length_m) *s.merge_length_m *= factor;
            })};
}

Step size_step(const Job& job, double factor) {
    const OutlineSpec& outline = leading_specimen(job).outline;
    const double width_mm = 1e3 * width_m(outline) * factor;
    const std::string label = outline.shape == Shape::rectangle
                                  ? fmt::format("{:.4g} x {:.4g} mm", width_mm, 1e3 * outline.height_m * factor)
                                  : fmt::format("{:.4g} mm", width_mm);
    return {label, width_mm, changed(job, [factor](SpecimenSpec& s) { s.outline = scaled(s.outline, factor); })};
}

Draft draft_of_sizes(const Job& job, const char* axis, const std::function<Step(const Job&, double)>& step,
                     std::initializer_list<double> factors, std::vector<std::string>& remarks) {
    Draft draft{axis, "mm", false, step(job, 1.0), {}};
    for (const double factor : factors) {
        Step next = step(job, factor);
        const double across = grains_across(next.job);
        if (across < least_width) {
            remarks.push_back(
                fmt::format("Left out: {} {}, a specimen narrower than five of its largest grains.", axis, next.label));
            continue;
        }
        if (across < good_width)
            remarks.push_back(fmt::format(
                "Doubtful: {} {}, a specimen only {:.1f} of its largest grains wide; ten are the least that is usual.", axis,
                next.label, across));
        draft.steps.push_back(std::move(next));
    }
    return draft;
}

// ---- triangles

Draft draft_of_triangles(const Job& job) {
    const auto step = [&](int triangles) {
        const std::string label = triangles == 0 ? "standard (15)" : std::to_string(triangles);
        return Step{label, triangles == 0 ? 15.0 : triangles,
                    changed(job, [triangles](SpecimenSpec& s) { s.triangles_per_grain = triangles; })};
    };
    const int own = job.specimen.triangles_per_grain;
    Draft draft{"triangles per grain", "", true, step(own), {}};
    for (const int triangles : {0, 30, 60})
        if (triangles != own) draft.steps.push_back(step(triangles));
    return draft;
}

// ---- loading rate

struct Rate {
    std::string name, unit;
    double base;  // in `unit` once multiplied by `shown`
    double shown;
    std::function<void(NumericsSpec&, double)> set;
    double least = 0.0, most = std::numeric_limits<double>::infinity();
};

Rate rate_of(const NumericsSpec& numerics) {
    if (numerics.kind == NumericsKind::dynamic)
        return {"loading speed", "m/s", numerics.speed_m.value_or(0.0), 1.0, [](NumericsSpec& n, double v) { n.speed_m = v; }};
    if (numerics.kind == NumericsKind::paper)
        return {"loading speed", "nm/step", numerics.speed_m.value_or(usual_paper_speed_m), 1e9,
                [](NumericsSpec& n, double v) { n.speed_m = v; }};
    if (numerics.residual_target)
        return {"residual target", "", *numerics.residual_target, 1.0, [](NumericsSpec& n, double v) { n.residual_target = v; }};
    return {"accuracy",      "%", numerics.accuracy, 100.0, [](NumericsSpec& n, double v) { n.accuracy = v; }, smallest_accuracy,
            largest_accuracy};
}

Draft draft_of_rate(const Job& job) {
    const Rate rate = rate_of(job.variants.front().numerics);
    const auto step = [&](double value) {
        Job other = job;
        rate.set(other.variants.front().numerics, value);
        return Step{fmt::format("{:.3g}{}{}", value * rate.shown, rate.unit.empty() ? "" : " ", rate.unit), value * rate.shown,
                    std::move(other)};
    };
    Draft draft{rate.name, rate.unit, true, step(rate.base), {}};
    for (const double factor : {4.0, 1.0 / 3.0}) {
        const double value = std::clamp(rate.base * factor, rate.least, rate.most);
        if (value != rate.base) draft.steps.push_back(step(value));
    }
    return draft;
}

// ---- the plan

void keep_tests(Job& job, const std::vector<std::string>& wanted) {
    const auto is_wanted = [&](const TestSpec& test) {
        if (wanted.empty()) return !method_of(test).specimen.confined;
        return std::find(wanted.begin(), wanted.end(), name(test.kind)) != wanted.end();
    };
    const std::string has = [&] {
        std::string kinds;
        for (const TestSpec& test : job.tests)
            if (kinds.find(name(test.kind)) == std::string::npos)
                kinds += (kinds.empty() ? "" : ", ") + std::string(name(test.kind));
        return kinds;
    }();
    for (const std::string& kind : wanted)
        if (std::none_of(job.tests.begin(), job.tests.end(), [&](const TestSpec& test) { return name(test.kind) == kind; }))
            throw InputError({{}, 0, 0, "--test"}, fmt::format("the job has no test '{}'", kind), has);
    std::erase_if(job.tests, [&](const TestSpec& test) { return !is_wanted(test); });
    if (job.tests.empty())
        throw InputError({{}, 0, 0, "--test"}, "the job has only biaxial tests, which are not taken unless they are asked for",
                         "--test biaxial");
    for (TestSpec& test : job.tests) test.seeds.clear();
}

std::vector<Draft> drafts_of(const Job& job, std::vector<std::string>& remarks) {
    std::vector<Draft> drafts;
    if (!job.specimen.packing_file.empty()) {
        remarks.emplace_back("Left out: grain size and specimen size, because the job loads a packing.");
    } else if (job.specimen.given_cells.given()) {
        remarks.emplace_back("Left out: grain size and specimen size, because the cells come from a file.");
    } else {
        drafts.push_back(draft_of_sizes(job, "grain size", grain_step, {0.75, 1.5}, remarks));
        drafts.push_back(draft_of_sizes(job, "specimen size", size_step, {0.75, 1.5}, remarks));
    }
    if (job.variants.front().model.kind == GrainKind::flexible)
        drafts.push_back(draft_of_triangles(job));
    else
        remarks.emplace_back("Left out: triangles per grain, because only flexible grains are meshed.");
    drafts.push_back(draft_of_rate(job));
    std::erase_if(drafts, [](const Draft& draft) { return draft.steps.empty(); });
    return drafts;
}

/// Adds the steps of a draft as points, in which the other axes keep the base's value.
ConvergeAxis add_axis(Study& study, std::vector<Draft>& drafts, std::size_t a) {
    ConvergeAxis axis{drafts[a].name, drafts[a].unit, drafts[a].same_packings, {0}, 0};
    for (Step& step : drafts[a].steps) {
        Point point{study.points.front().values, std::move(step.job)};
        point.values[a] = {step.label, step.number};
        axis.points.push_back(study.points.size());
        study.points.push_back(std::move(point));
    }
    std::sort(axis.points.begin(), axis.points.end(),
              [&](std::size_t i, std::size_t j) { return study.points[i].values[a].number < study.points[j].values[a].number; });
    axis.base = static_cast<std::size_t>(std::find(axis.points.begin(), axis.points.end(), std::size_t{0}) - axis.points.begin());
    return axis;
}

}  // namespace

ConvergePlan plan_convergence(const Job& job, const ConvergeOptions& options) {
    if (job.has_variants() && job.variants.size() > 1)
        throw InputError({job.file.string(), 0, 0, "variant"},
                         "convergence is asked of one rock at a time, but the job has several variants", "--variant NAME");
    ConvergePlan plan;
    plan.within = options.within;
    Job base = job;
    base.seeds = choose_seeds(job, options.seeds, usual_packings);
    base.variants.front().seeds.clear();
    keep_tests(base, options.tests);
    std::vector<Draft> drafts = drafts_of(base, plan.remarks);
    plan.study = study_of(base, job.name + "-converge",
                          options.results.value_or(std::filesystem::path("results") / (job.name + "-converge")));
    plan.study.title = "Convergence of " + job.name;
    plan.study.axes.clear();
    plan.study.points.front().values.clear();
    for (const Draft& draft : drafts) {
        plan.study.axes.push_back(draft.name);
        plan.study.points.front().values.push_back({draft.base.label, draft.base.number});
    }
    for (std::size_t a = 0; a < drafts.size(); ++a) plan.axes.push_back(add_axis(plan.study, drafts, a));
    index_runs(plan.study);
    return plan;
}

}  // namespace feldspar
