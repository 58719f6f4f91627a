// From the first moment of loading to the stop: steps, contacts, rate control, records (docs/theory/loading.md).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/disc_splitting.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/lab/recorder.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Tells the caller how the loading goes, at most a few times a second.
class ProgressReporter {
public:
    explicit ProgressReporter(const Experiment& e) : e_(e), expected_(typical_steps(e)) {}

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
    StopRule(const Experiment& e, const TestResult& result, long long first_step) : e_(e), result_(result), first_step_(first_step) {
        if (const auto disc = loaded_disc(result)) splitting_.emplace(*disc);
    }

    /// Strength so far, a positive magnitude.
    double peak() const { return peak_Pa_; }
    long long steps_to_peak() const { return peak_step_ - first_step_; }

    /// @return why the test ends now, in words; nothing if it goes on
    std::optional<std::string> ended(const HistoryRow& row) {
        const double load = e_.direction * row.axial_stress_Pa;
        if (load > peak_Pa_ && !split()) {
            peak_Pa_ = load;
            peak_step_ = e_.step;
            peak_strain_ = row.axial_strain;
        }
        look_for_split();
        const TestSpec& test = e_.setup.test;
        const long long after = e_.step - peak_step_;
        if (splitting_ && after >= 100 && row.axial_strain >= kPressedOn * peak_strain_)
            return fmt::format("the plates have approached {:g} times as far as at the {}", kPressedOn,
                               split() ? "strength of the disc" : "largest stress, and the disc is not split");
        if (after >= 100 && load <= test.stop_fraction * peak_Pa_ && (!splitting_ || split()))
            return fmt::format("the stress has fallen to {:.0f} % of the peak", 100.0 * test.stop_fraction);
        if (std::abs(row.axial_strain) >= test.maximum_strain)
            return fmt::format("the axial strain has reached its maximum of {:.3g}", test.maximum_strain);
        if (test.maximum_stress_Pa && load >= *test.maximum_stress_Pa)
            return fmt::format("the stress has reached its maximum of {:.4g} MPa", *test.maximum_stress_Pa / 1e6);
        if (e_.setup.numerics.maximum_steps && e_.step - first_step_ >= *e_.setup.numerics.maximum_steps)
            return fmt::format("the maximum number of steps ({}) is reached", *e_.setup.numerics.maximum_steps);
        return std::nullopt;
    }

private:
    static constexpr double kPressedOn = 2.0;   // a disc that was not split by then, or does not let go, is pressed no farther

    bool split() const { return splitting_ && splitting_->split(); }

    void look_for_split() {
        if (!splitting_) return;
        for (; cracks_seen_ < result_.cracks.size(); ++cracks_seen_) splitting_->add(result_.cracks[cracks_seen_]);
    }

    const Experiment& e_;
    const TestResult& result_;
    long long first_step_;
    std::optional<SplittingCrack> splitting_;   // of a Brazilian test: a first dip does not end it
    std::size_t cracks_seen_ = 0;
    double peak_strain_ = 0.0;
    double peak_Pa_ = 0.0;
    long long peak_step_ = 0;
};

// Contacts between grains, looked after every few steps.
void maintain_contacts(Experiment& e, ContactFinder& finder, ShapeWatch& watch, TestResult& result, int steps) {
    const ContactFinder::Changes changes = finder.update(e.assembly, e.mass_factor);
    e.rate_control_J += changes.kinetic_J + changes.elastic_J;   // heavier nodes took their speed along; contacts began with an overlap
    result.new_contacts += changes.made;
    const ShapeChoice shapes = watch.look(e.assembly, e.mass_factor);
    e.rate_control_J += shapes.kinetic_J;
    result.shape_fallbacks += static_cast<long long>(shapes.fallback_sides) * steps;
    if (shapes.fallback_sides > 0) result.angular_momentum_loss = std::max(result.angular_momentum_loss, fallback_moment_loss(e.assembly));
}

}  // namespace

double typical_steps(const Experiment& e) {
    const NumericsSpec& n = e.setup.numerics;
    const TestKind kind = e.setup.test.kind;
    if (n.kind != NumericsKind::adaptive) {
        const double strain = kind == TestKind::direct_tension ? 5e-4 : 6e-3;
        return strain * e.height_m / (n.speed_m.value_or(kPaperSpeed) * e.settings.dt);
    }
    const double base = kind == TestKind::brazilian ? 21000.0 : kind == TestKind::direct_tension ? 6500.0 : kind == TestKind::biaxial ? 35000.0 : 15000.0;
    NumericsSpec usual;
    return base * std::sqrt(residual_target(usual, kind, e.setup.model.kind) / residual_target(n, kind, e.setup.model.kind));
}

void load(Experiment& e, Recorder& recorder, TestResult& result) {
    const bool adaptive = e.setup.numerics.kind == NumericsKind::adaptive;
    const int block = adaptive ? 10 : 50;   // steps between records
    ContactFinder finder(e.assembly, 0.1 * mean_body_diameter(e.assembly));
    ShapeWatch watch(e.assembly);
    const GrainKind grains = e.setup.model.kind;
    const double target = residual_target(e.setup.numerics, e.setup.test.kind, grains);
    const double relative_target = target / residual_target(NumericsSpec{}, e.setup.test.kind, grains);
    RateControl control(e.setup.test.kind, target, relative_target, e.height_m, e.travel_time,
                        expected_strength(e.setup.contact, e.setup.test) * e.section_m2);
    LoadingModeUpdate mode_update(e.travel_time);
    const long long first_step = e.step;
    StopRule stop(e, result, first_step);
    ProgressReporter progress(e);
    if (adaptive) e.change_speed(control.start());
    stop.ended(recorder.record(Phase::loading));
    const Clock::time_point start = Clock::now();
    for (;;) {
        e.run(block);
        maintain_contacts(e, finder, watch, result, block);
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
            const double share_of_peak = stop.peak() > 0.0 ? e.direction * row.axial_stress_Pa / stop.peak() : 1.0;
            mode_update.observe(e.assembly, e.step, e.platen_travel_m);
            const double speed = control.next(e.settings.speed, recorder.unbalanced(), force, e.platen_travel_m, share_of_peak);
            if (speed != e.settings.speed) e.change_speed(speed);
        }
    }
    result.steps = e.step - first_step;
    result.steps_to_peak = stop.steps_to_peak();
    result.ms_per_step = result.steps > 0 ? 1e3 * seconds_since(start) / static_cast<double>(result.steps) : 0.0;
}

}  // namespace feldspar
