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
#include "feldspar/lab/properties.hpp"
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
    StopRule(const Experiment& e, const TestResult& result) : e_(&e), result_(&result) {
        if (const auto disc = loaded_disc(result)) splitting_.emplace(*disc);
    }

    /// Strength so far, a positive magnitude.
    double peak() const { return peak_Pa_; }
    long long peak_step() const { return peak_step_; }

    /// Whether the largest stress was the strength: the load has fallen below it, and a disc is split, for it dips and rises again before.
    bool past_peak(double load_Pa) const { return load_Pa < kPastPeak * peak_Pa_ && (!splitting_ || split()); }

    /// Whether all steps that the user allows have been made, those of earlier passages too.
    bool steps_are_spent() const { return e_->setup.numerics.maximum_steps && result_->steps >= *e_->setup.numerics.maximum_steps; }

    /// @return why the test ends now, in words; nothing if it goes on
    std::optional<std::string> ended(const HistoryRow& row) {
        const double load = e_->direction * row.axial_stress_Pa;
        if (load > peak_Pa_ && !split()) {
            peak_Pa_ = load;
            peak_step_ = e_->step;
            peak_strain_ = row.axial_strain;
        }
        look_for_split();
        const TestSpec& test = e_->setup.test;
        const long long after = e_->step - peak_step_;
        if (splitting_ && after >= 100 && row.axial_strain >= kPressedOn * peak_strain_)
            return fmt::format("the plates have approached {:g} times as far as at the {}", kPressedOn,
                               split() ? "strength of the disc" : "largest stress, and the disc is not split");
        if (after >= 100 && load <= test.stop_fraction * peak_Pa_ && (!splitting_ || split()))
            return fmt::format("the stress has fallen to {:.0f} % of the peak", 100.0 * test.stop_fraction);
        if (std::abs(row.axial_strain) >= test.maximum_strain)
            return fmt::format("the axial strain has reached its maximum of {:.3g}", test.maximum_strain);
        if (test.maximum_stress_Pa && load >= *test.maximum_stress_Pa)
            return fmt::format("the stress has reached its maximum of {:.4g} MPa", *test.maximum_stress_Pa / 1e6);
        if (steps_are_spent())
            return fmt::format("the maximum number of steps ({}) is reached", *e_->setup.numerics.maximum_steps);
        return std::nullopt;
    }

private:
    static constexpr double kPastPeak = 0.98;
    static constexpr double kPressedOn = 2.0;   // a disc that was not split by then, or does not let go, is pressed no farther

    bool split() const { return splitting_ && splitting_->split(); }

    void look_for_split() {
        if (!splitting_) return;
        for (; cracks_seen_ < result_->cracks.size(); ++cracks_seen_) splitting_->add(result_->cracks[cracks_seen_]);
    }

    const Experiment* e_;
    const TestResult* result_;
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
    const double base = kind == TestKind::brazilian ? 50000.0 : kind == TestKind::direct_tension ? 8000.0 : kind == TestKind::biaxial ? 35000.0 : 20000.0;
    NumericsSpec usual;
    return base * std::sqrt(residual_target(usual, kind) / residual_target(n, kind));
}

namespace {

// Everything that loading changes: a test may go back to it and pass the strength again, more slowly.
struct Loading {
    Assembly assembly;
    double platen_travel_m, rate_control_J, speed;
    long long step;
    bool stepped;
    PlatenWork platen_work;
    ContactFinder finder;
    ShapeWatch watch;
    LoadingModeUpdate mode_update;
    RateControl control;
    StopRule stop;
    Recorder::Mark record;
    int new_contacts;
    long long shape_fallbacks;
    double angular_momentum_loss;
    double load_Pa;   // magnitude
};

constexpr double kBetweenStates = 1.1;      // growth of the load between states that are kept
constexpr std::size_t kStates = 2;
constexpr double kBeforePeak = 0.9;         // share of the peak from where it is passed again: there the estimated error begins to look
// Of the wanted error: what each of its two parts may take in the next passage, and by how much two strengths that are the same may differ.
constexpr double kAim = 0.4, kSame = 0.5;
// How much stricter one passage is than the one before at most, and any than the first; and by which both limits fall
// in what counts as a repeat.
constexpr double kMostStricter = 0.1, kStrictest = 0.03, kRepeat = 0.5;
// Passages, and steps as a multiple of those of the first one, after which the strength is taken as it is; the grade then says how sure it is.
constexpr int kMostPassages = 8;
constexpr long long kMostSteps = 4;
// How long a body out of balance is waited for at a platen at rest, in travel times of a wave. A specimen that fails takes very long to come
// to rest by itself, so the platen then goes on slowly, by these shares of its travel in a travel time. If the specimen turns out to carry
// more, it had not failed: the test goes back and waits longer.
constexpr double kRunOut = 5.0, kFailingRunOut = 1.0, kPatience = 200.0;
constexpr double kFailsByItself = 0.01;    // R* of the typical body: a branch that softens quietly stays under control
constexpr double kFailing = 0.95, kFallen = 0.9;   // shares of the peak
constexpr double kGrowthFailing = 0.01, kGrowthFallen = 0.03;
constexpr double kGrowthAfterPeak = 0.1;   // most growth behind the peak

class Loader {
public:
    Loader(Experiment& e, Recorder& recorder, TestResult& result)
        : e_(e), recorder_(recorder), result_(result), finder_(e.assembly, 0.1 * mean_body_diameter(e.assembly)), watch_(e.assembly),
          mode_update_(e.travel_time), control_(first_passage(e.setup.numerics, e.setup.test.kind), e.travel_time), stop_(e, result), progress_(e) {}

    void run() {
        const long long first_step = e_.step;
        const int block = adaptive_ ? 10 : 50;   // steps between records
        if (adaptive_) e_.change_speed(control_.start(e_.platen_travel_m));
        if (const auto reason = stop_.ended(recorder_.record(Phase::loading))) {   // the computed start may end at the maximum stress
            result_.stop_reason = *reason;
            return;
        }
        const Clock::time_point start = Clock::now();
        for (;;) {
            e_.run(block);
            result_.steps += block;
            try {
                maintain_contacts(e_, finder_, watch_, result_, block);
            } catch (const NumericalError& error) {
                throw NumericalError(fmt::format("{} at step {} (platen travel {:.3g} m): the motion has become unstable", error.what(), e_.step, e_.platen_travel_m));
            }
            const HistoryRow& row = recorder_.record(Phase::loading);
            if (!std::isfinite(row.residual) || !std::isfinite(row.axial_stress_Pa))
                throw NumericalError(fmt::format("a force is not a number at step {} (axial strain {:.3g})", e_.step, row.axial_strain));
            const std::optional<std::string> reason = stop_.ended(row);
            progress_.loading(row, stop_.peak(), first_step);
            if (e_.stopped()) {
                result_.interrupted = true;
                result_.stop_reason = "interrupted by the user";
                break;
            }
            const double load = e_.direction * row.axial_stress_Pa;
            const double peak = stop_.peak(), unrest = static_cast<double>(e_.step - balanced_step_) / e_.travel_time;
            const bool past_peak = stop_.past_peak(load);
            if (adaptive_ && !stop_.steps_are_spent() && (reason || past_peak || (unrest > kRunOut && !e_.brazilian())) && passed_too_fast()) continue;
            if (reason) {
                result_.stop_reason = *reason;
                break;
            }
            if (!adaptive_) continue;
            if (!rushed_) keep_state(load);
            mode_update_.observe(e_.assembly, e_.step, e_.platen_travel_m);
            double slowest = 0.0;
            if (control_.residual() > kFailsByItself && unrest > (patient_ ? kPatience : load < kFailing * peak ? kFailingRunOut : kRunOut)) {
                slowest = load < kFallen * peak ? kGrowthFallen : kGrowthFailing;
                rushed_ = true;
            }
            control_.set_limits(past_peak && settled() ? after_peak_ : strict_);
            const double speed = control_.next(e_.settings.speed, recorder_.unbalanced(), std::abs(row.axial_stress_Pa) * e_.section_m2, e_.platen_travel_m, slowest);
            if (control_.balanced()) balanced_step_ = e_.step;
            if (speed != e_.settings.speed) e_.change_speed(speed);
        }
        result_.steps_to_peak = result_.steps - (e_.step - stop_.peak_step());
        result_.ms_per_step = result_.steps > 0 ? 1e3 * seconds_since(start) / static_cast<double>(result_.steps) : 0.0;
    }

private:
    // Keeps the states at which the load has grown by a tenth: the last ones, so that one lies before the peak, whenever that comes.
    void keep_state(double load_Pa) {
        if (!(load_Pa > 0.0) || load_Pa < kBetweenStates * (states_.empty() ? 0.0 : states_.back().load_Pa)) return;
        if (states_.size() == kStates) states_.erase(states_.begin());
        states_.push_back({e_.assembly, e_.platen_travel_m, e_.rate_control_J, e_.settings.speed, e_.step, e_.stepped, e_.platen_work, finder_, watch_,
                           mode_update_, control_, stop_, recorder_.mark(), result_.new_contacts, result_.shape_fallbacks,
                           result_.angular_momentum_loss, load_Pa});
    }

    // Goes back before the peak, with stricter limits, if the estimated error of the strength is larger than what is wanted; or with more
    // patience, if the specimen was thought to fail and was not waited for, and then carried more.
    bool passed_too_fast() {
        if (settled() || states_.empty()) return false;
        settled_Pa_ = stop_.peak();
        if (result_.passages == 1) first_steps_ = result_.steps;
        QuasiStaticEvidence& evidence = result_.evidence;
        evidence.confirmed = false;
        const QuasiStaticEvidence seen = judge(result_);
        if (seen.error_estimate <= wanted_) return false;
        const auto by = [](const PassageLimits& l, const PassageLimits& r) { return std::max(l.residual / r.residual, l.growth / r.growth); };
        if (passed_Pa_ > 0.0 && by(strict_, passed_with_) <= kRepeat) {   // a repeat: what did not change the strength is no error of it
            evidence.peak_change_at_third = stop_.peak() / passed_Pa_ - 1.0;
            evidence.confirmed = std::abs(evidence.peak_change_at_third) < kSame * wanted_;
        }
        if (evidence.confirmed) return false;
        if (result_.passages >= kMostPassages || result_.steps > kMostSteps * first_steps_) {
            patient_ = true;   // at least from here on
            return false;
        }
        passed_Pa_ = stop_.peak();
        passed_with_ = strict_;
        ++result_.passages;
        while (states_.size() > 1 && states_.back().load_Pa > kBeforePeak * stop_.peak()) states_.pop_back();
        if (rushed_ && !patient_ && !e_.brazilian()) {
            patient_ = true;
        } else {
            const double of_residual = residual_share(e_.setup.test.kind) * seen.residual_median, of_growth = seen.error_estimate - of_residual;
            strict_.residual = std::max(kStrictest * first_.residual, strict_.residual * std::clamp(kAim * wanted_ / of_residual, kMostStricter, 1.0));
            strict_.growth = std::max(kStrictest * first_.growth, strict_.growth * std::clamp(kAim * wanted_ / of_growth, kMostStricter, 1.0));
        }
        go_back_to(states_.back());
        return true;
    }

    bool settled() const { return stop_.peak() <= (1.0 + kSame * wanted_) * settled_Pa_; }

    void go_back_to(const Loading& state) {
        e_.assembly = state.assembly;
        e_.platen_travel_m = state.platen_travel_m;
        e_.rate_control_J = state.rate_control_J;
        e_.settings.speed = state.speed;
        e_.step = state.step;
        e_.stepped = state.stepped;
        e_.platen_work = state.platen_work;
        finder_ = state.finder;
        watch_ = state.watch;
        mode_update_ = state.mode_update;
        control_ = state.control;
        stop_ = state.stop;
        recorder_.go_back_to(state.record);
        result_.new_contacts = state.new_contacts;
        result_.shape_fallbacks = state.shape_fallbacks;
        result_.angular_momentum_loss = state.angular_momentum_loss;
        balanced_step_ = e_.step;
        rushed_ = false;
        settled_Pa_ = 0.0;
    }

    Experiment& e_;
    Recorder& recorder_;
    TestResult& result_;
    const bool adaptive_ = e_.setup.numerics.kind == NumericsKind::adaptive;
    ContactFinder finder_;
    ShapeWatch watch_;
    LoadingModeUpdate mode_update_;
    RateControl control_;
    StopRule stop_;
    ProgressReporter progress_;
    std::vector<Loading> states_;   // the oldest first
    const double wanted_ = accuracy_of(residual_target(e_.setup.numerics, e_.setup.test.kind), e_.setup.test.kind);
    double settled_Pa_ = 0.0;       // the peak whose passage was judged last
    long long first_steps_ = 0;     // of the first passage
    double passed_Pa_ = 0.0;        // strength of the passage before, and its limits
    PassageLimits passed_with_;
    const PassageLimits first_ = first_passage(e_.setup.numerics, e_.setup.test.kind), after_peak_{first_.residual, std::min(kGrowthAfterPeak, first_.growth)};
    PassageLimits strict_ = first_;   // of the passage under way, until its peak
    long long balanced_step_ = e_.step;   // when the typical body was within the target last
    bool rushed_ = false;           // the platen has gone on although the body was not in balance
    bool patient_ = false;          // wait long for balance
};

}  // namespace

void load(Experiment& e, Recorder& recorder, TestResult& result) { Loader(e, recorder, result).run(); }

}  // namespace feldspar
