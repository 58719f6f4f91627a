#include "feldspar/lab/run_test.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/lab/recorder.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/model/assemble.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Typical loading steps of a test, to be able to say how long it will take: measured on the Augig granite (docs/performance).
double typical_steps(const TestSetup& setup) {
    const NumericsSpec& n = setup.numerics;
    if (n.kind != NumericsKind::adaptive) {
        const double speed = n.kind == NumericsKind::paper ? n.speed_m.value_or(6.25e-9) : 0.0;
        const double strain = setup.test.kind == TestKind::direct_tension ? 5e-4 : 6e-3;
        const double height = 0.16;
        return speed > 0.0 ? strain * height / speed : 0.0;
    }
    const double base = setup.test.kind == TestKind::brazilian ? 40000.0 : setup.test.kind == TestKind::direct_tension ? 8000.0 : 12000.0;
    return base * std::pow((setup.test.kind == TestKind::brazilian ? 1e-2 : 5e-3) / residual_target(n, setup.test.kind), 0.5);
}

// Tells the caller how the loading goes, at most a few times a second.
class ProgressReporter {
public:
    explicit ProgressReporter(const Experiment& e) : e_(e), expected_(typical_steps(e.setup)) {}

    void loading(const HistoryRow& row, double peak_Pa, long long first_step) {
        if (!e_.control.progress) return;
        const double elapsed = seconds_since(start_);
        if (elapsed - last_ < 0.2) return;
        last_ = elapsed;
        const double steps = static_cast<double>(e_.step - first_step), rate = elapsed > 0.0 ? steps / elapsed : 0.0;
        TestProgress p;
        p.stage = "loading";
        p.step = e_.step - first_step;
        p.axial_strain = row.axial_strain;
        p.axial_stress_Pa = row.axial_stress_Pa;
        p.peak_stress_Pa = peak_Pa;
        p.cracks = row.cracks_tensile + row.cracks_shear;
        p.steps_per_second = rate;
        p.seconds_left = expected_ > steps && rate > 0.0 ? (expected_ - steps) / rate : -1.0;
        e_.control.progress(p);
    }

private:
    const Experiment& e_;
    double expected_;
    Clock::time_point start_ = Clock::now();
    double last_ = -1.0;
};

// When a test is over.
class StopRule {
public:
    StopRule(const Experiment& e, long long first_step) : e_(e), first_step_(first_step) {}

    /// Strength so far, a positive magnitude.
    double peak() const { return peak_Pa_; }
    long long steps_to_peak() const { return peak_step_ - first_step_; }

    /// @return why the test ends now, in words; nothing if it goes on
    std::optional<std::string> ended(const HistoryRow& row) {
        const double load = e_.direction * row.axial_stress_Pa;
        if (load > peak_Pa_) {
            peak_Pa_ = load;
            peak_step_ = e_.step;
        }
        const TestSpec& test = e_.setup.test;
        const long long after = e_.step - peak_step_;
        if (after >= 100 && load <= test.stop_fraction * peak_Pa_)
            return fmt::format("the stress has fallen to {:.0f} % of the peak", 100.0 * test.stop_fraction);
        if (std::abs(row.axial_strain) >= test.maximum_strain)
            return fmt::format("the axial strain has reached its maximum of {:.3g}", test.maximum_strain);
        if (e_.setup.numerics.maximum_steps && e_.step - first_step_ >= *e_.setup.numerics.maximum_steps)
            return fmt::format("the maximum number of steps ({}) is reached", *e_.setup.numerics.maximum_steps);
        return std::nullopt;
    }

private:
    const Experiment& e_;
    long long first_step_;
    double peak_Pa_ = 0.0;
    long long peak_step_ = 0;
};

// Contacts between grains, looked after every few steps.
void maintain_contacts(Experiment& e, ContactFinder& finder, TestResult& result, int steps) {
    const ContactFinder::Changes changes = finder.update(e.body, e.mass_factor);
    e.rate_control_J += changes.kinetic_J;   // nodes that became heavier took their speed with them
    result.new_contacts += changes.made;
    const int sides = choose_shape_functions(e.body);
    result.shape_fallbacks += static_cast<long long>(sides) * steps;
    if (sides > 0) result.angular_momentum_loss = std::max(result.angular_momentum_loss, fallback_moment_loss(e.body));
}

double mean_diameter(const Assembly& body) {
    double sum = 0.0;
    for (const Grain& grain : body.grains) sum += 2.0 * grain.radius_m;
    return sum / static_cast<double>(body.grains.size());
}

// Loads until the stop rule says so; the rows go to the recorder.
void load(Experiment& e, Recorder& recorder, TestResult& result) {
    const bool adaptive = e.setup.numerics.kind == NumericsKind::adaptive;
    const int block = adaptive ? 10 : 50;   // steps between records
    ContactFinder finder(e.body, 0.1 * mean_diameter(e.body));
    const double target = residual_target(e.setup.numerics, e.setup.test.kind);
    RateControl control(target, target / residual_target(NumericsSpec{}, e.setup.test.kind), e.height_m, e.travel_time,
                        expected_strength(e.setup.contact, e.setup.test) * e.section_m2);
    LoadingModeUpdate mode_update(e.travel_time, target);
    const long long first_step = e.step;
    StopRule stop(e, first_step);
    ProgressReporter progress(e);
    if (adaptive) e.change_speed(control.start());
    stop.ended(recorder.record(Phase::loading));
    const Clock::time_point start = Clock::now();
    for (;;) {
        e.run(block);
        maintain_contacts(e, finder, result, block);
        const HistoryRow& row = recorder.record(Phase::loading);
        if (!std::isfinite(row.residual) || !std::isfinite(row.axial_stress_Pa))
            throw NumericalError(fmt::format("a force is not a number at step {} (axial strain {:.3g})", e.step, row.axial_strain));
        const std::optional<std::string> reason = stop.ended(row);
        progress.loading(row, stop.peak(), first_step);
        if (reason || e.stopped()) {
            result.interrupted = !reason;
            result.stop_reason = reason.value_or("interrupted by the user");
            break;
        }
        if (adaptive) {
            const double force = std::abs(row.axial_stress_Pa) * e.section_m2;
            const bool past_peak = e.direction * row.axial_stress_Pa < 0.98 * stop.peak();
            const double unbalanced = unbalanced_force(e.body);
            mode_update.observe(e.body, e.step, e.platen_travel_m, control.residual(unbalanced, force));
            const double speed = control.next(e.settings.speed, unbalanced, force, e.platen_travel_m, past_peak);
            if (speed != e.settings.speed) e.change_speed(speed);
        }
    }
    result.steps = e.step - first_step;
    result.steps_to_peak = stop.steps_to_peak();
    result.ms_per_step = result.steps > 0 ? 1e3 * seconds_since(start) / static_cast<double>(result.steps) : 0.0;
}

// Compression left by unloading that vanished when the point broke (docs/theory/contacts.md).
long long count_vanished(const Assembly& body) {
    long long count = 0;
    for (const ContactPoint& point : body.points) count += point.lost_compression;
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

TestResult run_once(const TestSetup& setup, const RunControl& control) {
    const Clock::time_point start = Clock::now();
    TestResult result;
    result.test = setup.test;
    result.model = setup.model;
    result.contact = setup.contact;
    result.grain = setup.grain;
    result.numerics = setup.numerics;
    result.seed = setup.specimen->seed;
    result.specimen = setup.specimen;
    result.threads = control.threads;

    Experiment e(setup, control);
    choose_step(e);
    result.stable_omega2 = e.omega2;
    result.stable_limit = e.omega2_bound;
    Recorder recorder(e, result);
    try {
        prepare(e);
        HistoryRow from;   // where the computed start began: nothing, or the isotropic state
        if (e.setup.test.kind == TestKind::biaxial) {
            from = e.isotropic;
            from.phase = Phase::consolidation;
            HistoryRow unloaded;
            unloaded.phase = Phase::consolidation;
            result.history.push_back(unloaded);
            result.history.push_back(from);
        }
        if (setup.numerics.kind == NumericsKind::adaptive && e.computed_start) recorder.elastic_phase(from);
        load(e, recorder, result);
    } catch (const Interrupted&) {
        result.interrupted = true;
        result.stop_reason = "interrupted by the user";
    }
    result.preparation_steps = e.preparation_steps;
    recorder.finish();
    result.vanished_compressions = count_vanished(e.body);
    if (!result.history.empty()) result.energy_at_end = result.history.back().energy;
    result.energy_residual = largest_energy_residual(result.history);
    result.properties = measure(result);
    result.evidence = judge(result);
    result.wall_s = seconds_since(start);
    return result;
}

// The settings of the repeat: a third of the target, or of the speed.
TestSetup at_a_third(TestSetup setup) {
    NumericsSpec& n = setup.numerics;
    if (n.kind == NumericsKind::adaptive) {
        n.residual_target = residual_target(n, setup.test.kind) / 3.0;
    } else {
        n.speed_m = n.speed_m.value_or(6.25e-9) / 3.0;
    }
    return setup;
}

}  // namespace

TestResult run_test(const TestSetup& setup, const RunControl& control) {
    TestResult result = run_once(setup, control);
    if (setup.numerics.confirm && !result.interrupted) {
        const TestResult slower = run_once(at_a_third(setup), control);
        if (!slower.interrupted && slower.properties.peak_stress_Pa > 0.0) {
            result.evidence.confirmed = true;
            result.evidence.peak_change_at_third = slower.properties.peak_stress_Pa / result.properties.peak_stress_Pa - 1.0;
            result.evidence = judge(result);   // the repeat is part of the evidence
        }
        result.wall_s += slower.wall_s;
    }
    return result;
}

TestPreview preview_test(const TestSetup& setup, const RunControl& control) {
    Experiment e(setup, control);
    choose_step(e);
    TestPreview preview;
    preview.grains = static_cast<int>(e.body.grains.size());
    preview.contacts = static_cast<int>(e.body.contacts.size());
    preview.contact_points = static_cast<int>(e.body.points.size());
    preview.nodes = e.body.nodes.count();
    preview.triangles = static_cast<int>(e.body.triangles.size());
    preview.memory_bytes = e.body.memory_bytes();
    preview.omega2 = e.omega2;
    preview.omega2_limit = e.omega2_bound;
    Assembly real = e.body;
    set_real_masses(real, setup.grain.density_kg_m3);
    preview.stable_time_step_s = std::sqrt(e.omega2_bound / largest_omega2(real, e.team));
    constexpr int kTrial = 20;
    evaluate_forces(e.body, e.team, Strength::unlimited);
    const Clock::time_point start = Clock::now();
    e.run(kTrial);
    const double per_step = seconds_since(start) / kTrial;
    if (setup.numerics.kind == NumericsKind::dynamic) {
        const double strain = setup.test.kind == TestKind::direct_tension ? 5e-4 : 6e-3;
        preview.expected_steps = strain * e.height_m / (setup.numerics.speed_m.value_or(0.01) * e.settings.dt);
    } else {
        preview.expected_steps = typical_steps(setup);
    }
    preview.expected_seconds = preview.expected_steps * per_step;
    return preview;
}

}  // namespace feldspar
