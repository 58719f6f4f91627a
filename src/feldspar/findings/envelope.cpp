// Which tests the envelope takes.
#include "feldspar/findings/envelope.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/findings/choose_seeds.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/strength_envelope.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

constexpr int usual_packings = 5;

bool has(const Job& job, MethodId kind) {
    return std::any_of(job.tests.begin(), job.tests.end(), [kind](const TestSpec& test) { return test.kind == kind; });
}

/// The job's first test of a kind, else one with default settings.
TestSpec pattern_of(const Job& job, MethodId kind) {
    const auto found =
        std::find_if(job.tests.begin(), job.tests.end(), [kind](const TestSpec& test) { return test.kind == kind; });
    if (found != job.tests.end()) return *found;
    const MethodSpecimen& method = method_of(kind).specimen;
    TestSpec test = usual_test(kind);
    if (method.confined) test.stop_fraction = enough_fall;
    test.control = usual_control(kind, std::any_of(job.variants.begin(), job.variants.end(),
                                                   [](const Variant& v) { return v.numerics.kind == NumericsKind::adaptive; }));
    const bool particles = std::any_of(job.variants.begin(), job.variants.end(),
                                       [](const Variant& v) { return v.model.kind != GrainKind::flexible; });
    if (method.own_disc || (particles && !method.glued)) test.plate_mu = method.plate_mu;
    return test;
}

std::vector<double> stresses_of(const Job& job, const EnvelopeOptions& options, std::vector<std::string>& remarks) {
    std::vector<double> stresses = options.sigma3_Pa;
    if (stresses.empty())
        for (const TestSpec& test : job.tests)
            if (method_of(test).specimen.confined) stresses.push_back(test.sigma3_Pa);
    if (stresses.empty()) {
        const double expected = expected_UCS_Pa(job);
        stresses = default_series(expected);
        std::vector<double> shown;
        for (const double s : stresses) shown.push_back(s * MPa);
        remarks.push_back(
            fmt::format("The job has no biaxial test: sigma_3 = {:g} MPa, from an expected uniaxial strength of {:.3g} MPa.",
                        fmt::join(shown, ", "), expected * MPa));
    }
    std::sort(stresses.begin(), stresses.end());
    stresses.erase(std::unique(stresses.begin(), stresses.end()), stresses.end());
    return stresses;
}

void check_outline(const Job& job) {
    const Shape shape = job.specimen.outline.shape;
    if (shape == Shape::disc || shape == Shape::half_disc || shape == Shape::ring)
        throw InputError({job.file.string(), 0, 0, "specimen.shape"},
                         fmt::format("an envelope needs compression tests, which press on flat ends, and a {} has none",
                                     shape == Shape::disc   ? "disc"
                                     : shape == Shape::ring ? "ring"
                                                            : "half disc"),
                         "shape = \"rectangle\"; the Brazilian test cuts its own disc");
}

}  // namespace

double expected_UCS_Pa(const Job& job) {
    const auto known = [&](const char* key) { return job.laboratory.contains(key); };
    if (known("UCS")) return job.laboratory.at("UCS");
    if (known("cohesion") && known("friction_angle"))
        return mohr_coulomb_UCS_Pa(job.laboratory.at("cohesion"), in_degrees(job.laboratory.at("friction_angle")));
    return 4.0 * job.variants.front().contact.tau_Pa;
}

std::vector<double> default_series(double expected_UCS_Pa) {
    std::vector<double> series;
    for (const double share : {0.025, 0.05, 0.10, 0.15}) {
        const double stress = share * expected_UCS_Pa, step = 0.5 * std::pow(10.0, std::floor(std::log10(stress)));
        const double rounded = step * std::round(stress / step);
        if (series.empty() || rounded > series.back()) series.push_back(rounded);
    }
    return series;
}

EnvelopePlan plan_envelope(const Job& job, const EnvelopeOptions& options) {
    check_outline(job);
    EnvelopePlan plan;
    Job whole = job;
    whole.seeds = choose_seeds(job, options.seeds, usual_packings);
    for (Variant& variant : whole.variants) variant.seeds.clear();
    const MethodId compression = method_of_strength("UCS"), confined = method_of_confined_strength(),
                   tension = method_of_strength("DTS"), splitting = method_of_strength("BTS");
    whole.tests = {pattern_of(job, compression)};
    for (const double sigma3_Pa : stresses_of(job, options, plan.remarks)) {
        whole.tests.push_back(pattern_of(job, confined));
        whole.tests.back().sigma3_Pa = sigma3_Pa;
    }
    whole.tests.push_back(pattern_of(job, tension));
    if (has(job, splitting)) {
        whole.tests.push_back(pattern_of(job, splitting));
    } else if (const auto disc = usual_disc(job.specimen)) {
        whole.tests.push_back(pattern_of(job, splitting));
        whole.tests.back().specimen = *disc;
    } else {
        plan.remarks.emplace_back(
            "No Brazilian test: the specimen is a polygon, which does not say how large the disc is to be.");
    }
    for (TestSpec& test : whole.tests) test.seeds.clear();
    for (const MethodId kind : {compression, tension, splitting})
        if (!has(job, kind) && has(whole, kind))
            plan.remarks.push_back(fmt::format("The job has no {} test: one with default settings was added.", name(kind)));
    plan.study = study_of(whole, job.name + "-envelope",
                          options.results.value_or(std::filesystem::path("results") / (job.name + "-envelope")));
    plan.study.title = "Strength envelope of " + job.name;
    return plan;
}

}  // namespace feldspar
