#include "feldspar/lab/run_test.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "feldspar/base/error.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/lab/acoustic_emission.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/foresee.hpp"
#include "feldspar/lab/keep_test.hpp"
#include "feldspar/lab/memory.hpp"
#include "feldspar/lab/nearest_to_failure.hpp"
#include "feldspar/lab/observer.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/lab/recorder.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/lab/test_watch.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/model/texture.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

// Compression left by unloading that vanished when the point broke (docs/theory/contacts.md).
long long count_vanished(const Assembly& assembly) {
    long long count = 0;
    for (const ContactPoint& point : assembly.points) count += point.lost_compression;
    return count;
}

// Relative to the work supplied until then; while this is under a twentieth of all, relative to that twentieth: the first
// steps of a body at rest have next to nothing to compare with.
double largest_energy_residual(const std::vector<HistoryRow>& history) {
    double all = 0.0, largest = 0.0;
    for (const HistoryRow& row : history) all = std::max(all, row.energy.supplied());
    for (const HistoryRow& row : history)
        if (row.phase == Phase::loading && all > 0.0)
            largest = std::max(largest, std::abs(row.energy.residual()) / std::max(row.energy.supplied(), 0.05 * all));
    return largest;
}

// With what the setup gives.
TestResult begin_result(const TestSetup& setup) {
    TestResult result;
    result.test = setup.test;
    result.model = setup.model;
    result.contact = setup.contact;
    result.grain = setup.grain;
    result.rock = setup.rock;
    if (setup.rock.any() || setup.specimen->quality.crystals > 0)
        result.texture = Texture(*setup.specimen, setup.grain, setup.contact, setup.rock).summary();
    result.numerics = setup.numerics;
    result.seed = setup.specimen->seed;
    result.specimen = setup.specimen;
    return result;
}

// Hands the body on when the test is over.
struct Leaving {
    TestObserver* observer;
    Assembly& assembly;
    ~Leaving() {
        if (observer != nullptr) observer->leaves(std::move(assembly));
    }
};

TestResult run_once(const TestSetup& setup, const RunControl& control, TestKeeping& keeping) {
    TestResult result = begin_result(setup);
    if (keeping.take_finished(result)) return result;

    Experiment e(setup, control);
    const Leaving leaving{control.observer, e.assembly};
    result.gauges = e.gauges.specs();
    result.length_m = e.length_m;
    result.section_m2 = e.section_m2;
    choose_step(e);
    const std::unique_ptr<StepDevice> device = control.device ? control.device() : nullptr;
    e.settings.device = device.get();
    result.stable_omega2 = e.omega2;
    result.stable_limit = e.omega2_bound;
    Recorder recorder(e, result);
    keeping.begin(e.state());
    e.keeping = &keeping;
    try {
        if (!keeping.goes_on(TestPart::loading)) {
            prepare(e);
            HistoryRow from;  // where the computed start began: nothing, or the state under dead loads
            if (e.has_dead_loads()) {
                from = e.consolidated;
                from.phase = Phase::consolidation;
                HistoryRow unloaded;
                unloaded.phase = Phase::consolidation;
                result.history.push_back(unloaded);
                result.history.push_back(from);
            }
            if (setup.numerics.kind == NumericsKind::adaptive && e.computed_start) recorder.elastic_phase(from);
            result.travel_time = e.travel_time;
            result.travel_steps = e.travel_time / e.settings.dt;
        }
        load(e, recorder, result);
    } catch (const Interrupted&) {
        result.interrupted = true;
        result.stop_reason = "interrupted by the user";
    } catch (const NumericalError& error) {
        result.stop_reason = error.what();
        recorder.finish();
        if (control.failed && !result.history.empty()) control.failed(result);
        throw;
    }
    result.preparation_steps = e.preparation_steps;
    result.travel_time = e.travel_time;
    result.travel_steps = e.travel_time / e.settings.dt;
    result.threads = e.team.size();
    recorder.finish();
    result.vanished_compressions = count_vanished(e.assembly);
    result.nearest = nearest_to_failure(e.assembly);
    if (!result.history.empty()) result.energy_at_end = result.history.back().energy;
    result.energy_residual = largest_energy_residual(result.history);
    result.properties = measure(result);
    if (result.stop_reason == kEndedByUser)
        result.properties.remarks.push_back("The test was ended by the user, before its own end.");
    result.emission = acoustic_emission(result);  // reads moduli, too
    result.evidence = judge(result);
    result.wall_s = keeping.seconds();
    if (!result.interrupted) keeping.add_finished(result);
    return result;
}

// The settings of the repeat: a third of the target, or of the speed.
TestSetup at_a_third(TestSetup setup) {
    NumericsSpec& n = setup.numerics;
    if (n.kind == NumericsKind::adaptive) {
        n.residual_target = residual_target(n, setup.test.kind) / 3.0;
    } else {
        n.speed_m = n.speed_m.value_or(kPaperSpeed) / 3.0;
    }
    return setup;
}

// Another damping than the test's own, as far from it as 0.5 is from the usual 0.7.
double other_damping(double damping) { return damping > 0.6 ? damping - 0.2 : damping + 0.2; }

// Once, and again where the numerics ask for it.
TestResult run_with_repeats(const TestSetup& setup, const RunControl& control) {
    TestKeeping keeping(control.observer == nullptr ? control.keeper : nullptr);
    TestResult result = run_once(setup, control, keeping);
    if (!setup.numerics.confirm || result.interrupted || result.stop_reason == kEndedByUser) return result;
    bool interrupted = false, ended = false;
    const auto peak_change = [&](const TestSetup& changed) -> std::optional<double> {  // none if the repeat shows no strength
        const TestResult repeat = run_once(changed, control, keeping);
        result.wall_s += repeat.wall_s;
        interrupted = repeat.interrupted;
        ended = repeat.stop_reason == kEndedByUser;
        if (repeat.interrupted || ended || !(repeat.properties.peak_stress_Pa > 0.0)) return std::nullopt;
        return repeat.properties.peak_stress_Pa / result.properties.peak_stress_Pa - 1.0;
    };
    if (const auto change = peak_change(at_a_third(setup))) {
        result.evidence.confirmed = true;
        result.evidence.peak_change_at_third = *change;
    }
    if (setup.numerics.kind != NumericsKind::dynamic && !interrupted && !ended) {
        TestSetup damped = setup;
        damped.numerics.damping = other_damping(setup.numerics.damping);
        if (const auto change = peak_change(damped)) {
            result.evidence.other_damping = damped.numerics.damping;
            result.evidence.peak_change_at_other_damping = *change;
        }
    }
    result.evidence = judge(result);  // the repeats are part of the evidence
    result.interrupted = interrupted;
    return result;
}

}  // namespace

TestResult run_test(const TestSetup& given, const RunControl& control) {
    TestSetup setup = given;
    if (control.observer != nullptr)
        if (const auto first = control.observer->begins()) {
            if (!stages_of(setup.test).empty())
                throw InputError({.key = "test.stages"}, "the test has stages of its own, and an observer begins others",
                                 "a test without stages, or an observer that does not begin any");
            setup.test.stages = {{{*first}}};
        }
    for (;;) {
        try {
            return run_with_repeats(setup, control);
        } catch (const StateError& error) {  // from what was kept: without that there is none
            control.keeper->refuse(error.what());
        }
    }
}

void keep_result(const TestResult& result, const StatePut& put) {
    const StateBase nothing;
    StateWriter writer(put, nothing);
    keep_course(writer, const_cast<TestResult&>(result));  // it only looks at it
}

TestResult kept_result(const TestSetup& setup, std::span<const char> kept) {
    TestResult result = begin_result(setup);
    StateReader reader(kept);
    keep_course(reader, result);
    if (!reader.at_end()) throw StateError("more follows than belongs to it");
    return result;
}

TestPreview preview_test(const TestSetup& setup, const RunControl& control) {
    Experiment e(setup, control);
    set_real_masses(e.assembly);  // replaced below
    const double real_omega2 = largest_omega2(e.assembly, e.team);
    choose_step(e);
    TestPreview preview;
    preview.grains = static_cast<int>(setup.specimen->cells.cells.size());
    preview.bodies = static_cast<int>(std::count_if(e.assembly.bodies.begin(), e.assembly.bodies.end(),
                                                    [](const Body& b) { return b.kind != BodyKind::plate; }));
    preview.contacts = static_cast<int>(e.assembly.contacts.size());
    preview.contact_points = static_cast<int>(e.assembly.points.size());
    preview.nodes = e.assembly.nodes.count();
    preview.triangles = static_cast<int>(e.assembly.triangles.size());
    preview.omega2 = e.omega2;
    preview.omega2_limit = e.omega2_bound;
    preview.stable_time_step_s = std::sqrt(e.omega2_bound / real_omega2);
    constexpr int kTrial = 20;
    evaluate_forces(e.assembly, e.team, Strength::unlimited);
    const Clock::time_point start = Clock::now();
    e.run(kTrial);
    preview.step_seconds = seconds_since(start) / kTrial;
    preview.steps = foreseen_steps(e);
    preview.memory_bytes = memory_of_run(setup, e.assembly, preview.steps);
    return preview;
}

}  // namespace feldspar
