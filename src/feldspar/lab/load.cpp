// From the first moment of loading to the stop: steps, contacts, rate control, records (docs/theory/loading.md).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/post_peak.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/lab/recorder.hpp"
#include "feldspar/lab/servo.hpp"
#include "feldspar/lab/stages.hpp"
#include "feldspar/lab/stop_rule.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

// Tells the caller how the loading goes, at most a few times a second.
class ProgressReporter {
public:
    explicit ProgressReporter(const Experiment& e) : e_(e), usual_(typical_steps(e)) {}

    /// @param steps   of all passages so far
    /// @param in_all  that the test is now expected to take; 0: as is usual
    void loading(const HistoryRow& row, double peak_Pa, long long steps_made, double in_all) {
        if (!e_.control.progress) return;
        const double elapsed = seconds_since(start_);
        if (elapsed - last_ < 0.2) return;
        last_ = elapsed;
        const double steps = static_cast<double>(steps_made), rate = elapsed > 0.0 ? steps / elapsed : 0.0, expected = in_all > 0.0 ? in_all : usual_;
        TestProgress p;
        p.stage = "loading";
        p.step = steps_made;
        p.axial_strain = row.axial_strain;
        p.axial_stress_Pa = row.axial_stress_Pa;
        p.peak_stress_Pa = peak_Pa;
        p.cracks = row.cracks_tensile + row.cracks_shear;
        p.steps_per_second = rate;
        p.seconds_left = expected > steps && rate > 0.0 ? (expected - steps) / rate : -1.0;
        e_.control.progress(p);
    }

private:
    const Experiment& e_;
    double usual_;
    Clock::time_point start_ = Clock::now();
    double last_ = -1.0;
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

// How many times as long as a plain test one with stages typically takes: a stage about a third of it.
double stages_over_test(const Experiment& e) {
    constexpr double kOfATest = 0.3;
    constexpr int kUntilTheEnd = 8;   // repetitions of what is repeated until the test ends
    double stages = 0.0;
    for (const StageGroup& group : e.stages) stages += static_cast<double>(group.stages.size()) * (group.times == 0 ? kUntilTheEnd : group.times);
    return stages > 1.0 ? 1.0 + kOfATest * (stages - 1.0) : 1.0;
}

double typical_steps(const Experiment& e) {
    const NumericsSpec& n = e.setup.numerics;
    const MethodId kind = e.setup.test.kind;
    if (n.kind != NumericsKind::adaptive) {
        return e.method.rate.fixed_speed_strain * e.length_m / (n.speed_m.value_or(kPaperSpeed) * e.settings.dt);
    }
    // In travel times, at the usual accuracy: medians over eight rocks (docs/validation, true strengths). The time of a mode is known once the elastic
    // answer is; a beam with a span of 4 h takes 1.5 times as long as a wave through its whole length.
    constexpr double kModeOverWave = 1.5;
    const double time = e.travel_time * (e.method.start.time_of_mode && e.preparation_steps == 0 ? kModeOverWave : 1.0);
    return stages_over_test(e) * e.method.rate.travel_times * time * std::sqrt(residual_target(NumericsSpec{}, kind) / residual_target(n, kind));
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
    Servo servo, arrest;
    StopRule stop;
    StageCursor stages;
    int stage;
    std::vector<StageRecord> stage_records;
    double largest_travel_m;
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
// Multiple of those steps after which a passage under way has its limits widened, in proportion to its own steps: a specimen that yields at
// constant load for ever would never be through. The grade then says how sure the strength is.
constexpr double kLongPassage = 20.0;
constexpr double kUsualPassages = 3.5;   // steps of a whole test over those of the first passage, for the time left
// How long a body out of balance is waited for at a platen at rest, in travel times of a wave. A crack that runs away has run out by then. What
// is not at rest fails slowly by itself, and may need a hundred travel times to lose a tenth of its load: the platen goes on, by this multiple
// of the wanted accuracy in a travel time, slowly enough that the strength does not notice.
constexpr double kRunOut = 5.0, kFailsByItself = 0.01;   // R* of the typical body: a branch that softens quietly stays under control
constexpr double kGrowthFailing = 0.2;
constexpr double kServoShare = 0.5;    // of the wanted accuracy: with half of it the branch changes by 5 % in strain at most (docs/decisions, servo control)
// A test with stages: the growth of the travel in a travel time with which a reversal of the volumetric strain is looked for; the share of the largest
// load from which on states are kept in a later stage; and how long a change of pressure takes that changes it altogether, in travel times.
constexpr double kGrowthSeen = 0.1, kKeptFrom = 0.5, kConfining = 30.0, kLeastConfining = 3.0;
constexpr double kPatience = 100.0;   // travel times after which it goes on faster, in proportion: what creeps for ever is not waited for

class Loader {
public:
    Loader(Experiment& e, Recorder& recorder, TestResult& result)
        : e_(e), recorder_(recorder), result_(result), finder_(e.assembly, 0.1 * mean_body_diameter(e.assembly)), watch_(e.assembly),
          mode_update_(e.travel_time), control_(first_passage(e.setup.numerics, e.setup.test.kind), e.travel_time),
          servo_(branch_is_followed(result) ? e.setup.test.control : LoadControl::displacement, kServoShare * wanted_, e.travel_time,
                 static_cast<std::size_t>(std::max(0, e.gauges.find(e.setup.test.control_gauge)))),
          arrest_(LoadControl::dissipation, kServoShare * wanted_, e.travel_time), stop_(e, result), stages_(e), progress_(e) {}

    void run() {
        const int block = adaptive_ ? 10 : 50;   // steps between records
        if (adaptive_ && stages_.loads()) e_.change_speed(control_.start(e_.platen_travel_m));
        const HistoryRow& first = recorder_.record(Phase::loading);
        if (stages_.staged()) begin_stage(first_row());
        if (const auto reason = stop_.ended(first, stages_.loads())) {   // the computed start may end at the maximum stress
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
            servo_.observe(row, block);
            std::optional<std::string> reason = stop_.ended(row, stages_.loads(), servo_.unloading());
            if (!reason && stages_.staged()) reason = stages_.stuck(row);
            progress_.loading(row, stop_.peak(), result_.steps, kUsualPassages * static_cast<double>(first_steps_));
            if (e_.stopped()) {
                result_.interrupted = true;
                result_.stop_reason = "interrupted by the user";
                break;
            }
            const double load = e_.direction * row.axial_stress_Pa;
            const bool past_peak = stages_.loads() && stop_.past_peak(load);
            if (adaptive_ && stages_.loads() && !stop_.steps_are_spent() && (reason || past_peak || (unrest() > kRunOut && e_.method.reading != Reading::disc)) && passed_too_fast()) continue;
            if (reason) {
                result_.stop_reason = *reason;
                break;
            }
            if (!adaptive_) continue;
            if (stages_.loads()) keep_state(load);
            mode_update_.observe(e_.assembly, e_.step, e_.platen_travel_m, stages_.staged());
            const bool known = past_peak && settled();
            control_.set_limits(known ? first_ : limits(load));
            if (stages_.staged()) {
                if (!go_on_in_stages(row, block, known)) break;
                continue;
            }
            double speed = control_.next(std::max(0.0, e_.settings.speed), recorder_.unbalanced(), force_scale(row),
                                         e_.platen_travel_m, slowest_growth());
            if (known && servo_.on()) {   // in balance the body takes what the rate control gives; out of balance it fails, and the servo leads
                const double allowed = servo_.speed(e_.platen_travel_m);
                speed = control_.balanced() ? std::max(speed, allowed) : allowed;
            }
            if (control_.balanced()) balanced_step_ = e_.step;
            if (speed != e_.settings.speed) e_.change_speed(speed);
        }
        if (!result_.stages.empty()) result_.stages.back().last_row = result_.history.size() - 1;
        result_.steps_to_peak = result_.steps - (e_.step - stop_.peak_step());
        result_.ms_per_step = result_.steps > 0 ? 1e3 * seconds_since(start) / static_cast<double>(result_.steps) : 0.0;
    }

private:
    // Keeps the states at which the load has grown by a tenth: the last ones, so that one lies before the peak, whenever that comes.
    void keep_state(double load_Pa) {
        if (stages_.staged() && load_Pa < kKeptFrom * stop_.peak()) return;
        if (!(load_Pa > 0.0) || load_Pa < kBetweenStates * (states_.empty() ? 0.0 : states_.back().load_Pa)) return;
        if (states_.size() == kStates) states_.erase(states_.begin());
        states_.push_back({e_.assembly, e_.platen_travel_m, e_.rate_control_J, e_.settings.speed, e_.step, e_.stepped, e_.platen_work, finder_, watch_,
                           mode_update_, control_, servo_, arrest_, stop_, stages_, e_.stage, result_.stages, largest_travel_m_, recorder_.mark(), result_.new_contacts, result_.shape_fallbacks,
                           result_.angular_momentum_loss, load_Pa});
    }

    // Of the passage under way. On the plateau of a confined specimen, below a strength that is known, it may be out of balance by as much as the
    // load is below it, and the load may grow by that in a travel time: more would be needed to show a strength that is none.
    PassageLimits limits(double load_Pa) const {
        if (stages_.staged() && !stages_.loads()) return first_;   // no strength is passed
        if (stages_.staged() && stages_.now().end == StageEnd::reversal) return {strict_.residual, std::min(strict_.growth, kGrowthSeen)};
        if (stages_.staged() && settled_Pa_ > 0.0 && settled()) return first_;   // below a strength that is known
        if (first_steps_ == 0) return strict_;
        const double wider = std::max(1.0, static_cast<double>(result_.steps - passage_start_) / (kLongPassage * static_cast<double>(first_steps_)));
        const double below = e_.confined() && settled() ? std::max(0.0, 1.0 - load_Pa / stop_.peak()) : 0.0;
        return {std::min(first_.residual, wider * strict_.residual + below / e_.method.rate.residual_share),
                std::min(first_.growth, wider * strict_.growth + below)};
    }

    // How fast the platen goes on at least, as a growth of its travel in a travel time of a wave: while the specimen fails by itself, and
    // while a confined one is in balance to its part of the wanted error. It yields on a plateau of many events, any of which may have made
    // the limits stricter than that, and the wait for them would be without end.
    double slowest_growth() const {
        const double slow = kGrowthFailing * wanted_;
        if (e_.confined() && e_.method.rate.residual_share * control_.residual() < kAim * wanted_) return slow;
        return control_.residual() > kFailsByItself && unrest() > kRunOut ? slow * std::max(1.0, unrest() / kPatience) : 0.0;
    }

    // Beside which unbalanced forces are small, N. What the dead loads leave out of balance says nothing while the load is small beside them.
    double force_scale(const HistoryRow& row) const { return std::max(std::abs(row.axial_stress_Pa) * e_.section_m2, 0.5 * e_.dead_load_N); }

    // How long the typical body has been out of balance, in travel times of a wave.
    double unrest() const { return static_cast<double>(e_.step - balanced_step_) / e_.travel_time; }

    // Goes back before the peak, with stricter limits, if the estimated error of the strength is larger than what is wanted.
    bool passed_too_fast() {
        if (stages_.staged() && !stop_.peak_in_stage()) settled_Pa_ = stop_.peak();   // where the stage turned, not where the rock failed
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
        if (result_.passages >= kMostPassages || result_.steps > kMostSteps * first_steps_) return false;
        passed_Pa_ = stop_.peak();
        passed_with_ = strict_;
        const double of_residual = e_.method.rate.residual_share * seen.residual_median, of_growth = seen.error_estimate - of_residual;
        strict_.residual = std::max(kStrictest * first_.residual, strict_.residual * std::clamp(kAim * wanted_ / of_residual, kMostStricter, 1.0));
        strict_.growth = std::max(kStrictest * first_.growth, strict_.growth * std::clamp(kAim * wanted_ / of_growth, kMostStricter, 1.0));
        pass_again();
        return true;
    }

    void pass_again() {
        ++result_.passages;
        while (states_.size() > 1 && states_.back().load_Pa > kBeforePeak * stop_.peak()) states_.pop_back();
        go_back_to(states_.back());
    }

    // Where the loading begins: the last row of a consolidation, or the first row.
    std::size_t first_row() const {
        std::size_t row = 0;
        while (row + 1 < result_.history.size() && result_.history[row + 1].phase == Phase::consolidation) ++row;
        return row;
    }

    // @param row  in whose state the stage begins; of the first one that from which the start was computed
    void begin_stage(std::size_t row) {
        result_.stages.push_back({stages_.kind(), stages_.group_number(), stages_.pass(), row, row, {}});
        stages_.begin(result_.history[row]);
        stop_.stage_began();
        states_.clear();
    }

    // What the loading motion does until the next row of a test with stages. @return false when the last stage has ended
    bool go_on_in_stages(const HistoryRow& row, int block, bool known) {
        const double load = e_.direction * row.axial_stress_Pa;
        largest_travel_m_ = std::max(largest_travel_m_, e_.platen_travel_m);
        double pace = control_.next(std::max(0.0, stages_.sense() * e_.settings.speed), recorder_.unbalanced(), force_scale(row),
                                    largest_travel_m_, slowest_growth());
        if (control_.balanced()) balanced_step_ = e_.step;
        const bool past_peak = stages_.loads() && stop_.past_peak(load);
        arrest_.observe(row, block);
        if (const auto why = stages_.ended(row, stop_.peak(), past_peak, control_.residual() / first_.residual)) {
            // A stage that ends while its specimen fails, as by its widening, has passed a strength too.
            const bool fails = stages_.loads() && (!control_.balanced() || load < (1.0 - kSame * wanted_) * stop_.stage_peak());
            if (fails && passed_too_fast()) return true;
            result_.stages.back().ended = *why;
            result_.stages.back().last_row = result_.history.size() - 1;
            if (stages_.failed(stop_.stage_peak(), e_.setup.test.stop_fraction * stop_.peak())) {
                e_.change_speed(0.0);
                result_.stop_reason = stop_.fallen();
                return false;
            }
            if (!stages_.next()) {
                e_.change_speed(0.0);
                result_.stop_reason = "the last stage is done: " + *why;
                return false;
            }
            ++e_.stage;
            begin_stage(result_.history.size() - 1);
            mode_update_.forget();
            pace = control_.start(largest_travel_m_);
            known = false;
        }
        double speed = stages_.sense() * pace;
        if (known && servo_.on()) {
            const double allowed = servo_.speed(e_.platen_travel_m);
            speed = control_.balanced() ? std::max(speed, allowed) : allowed;
        }
        if (stages_.kind() == StageKind::confine) speed = confine(row, block);
        // What fails while it is unloaded, or pressed, is taken back by the loading motion: at rest it would run away.
        if (stages_.kind() == StageKind::unload || stages_.kind() == StageKind::confine) speed = std::min(speed, -arrest_.arrest(largest_travel_m_));
        const double most = stages_.approach_m(stop_.peak()) / (block * e_.settings.dt);
        if (std::abs(speed) > most && stages_.sense() != 0.0 && speed * stages_.sense() > 0.0) speed = stages_.sense() * most;
        if (speed != e_.settings.speed) e_.change_speed(speed);
        return true;
    }

    // A part of the change of pressure, unless the body is out of balance. @return the speed with which the loading motion follows
    double confine(const HistoryRow& row, int block) {
        const StageSpec& stage = stages_.now();
        for (std::size_t i = 0; i < e_.assembly.dead_loads.size(); ++i) {
            double& pressure = e_.assembly.dead_loads[i].pressure_Pa;
            const double change = stage.sigma3_Pa - stages_.begun_Pa(i), whole = std::max(stage.sigma3_Pa, stages_.begun_Pa(i));
            if (change == 0.0 || !stages_.changes(i)) continue;
            const double times = std::max(kLeastConfining, kConfining * std::abs(change) / whole);
            const double share = control_.balanced() ? 1.0 : unrest() > kRunOut ? kGrowthFailing : 0.0;
            const double next = pressure + share * change * block * e_.settings.dt / (times * e_.travel_time);
            pressure = change > 0.0 ? std::min(next, stage.sigma3_Pa) : std::max(next, stage.sigma3_Pa);
        }
        if (stage.keep == ConfineKeep::motion) return 0.0;
        const double missing_N = (stages_.begun_load_Pa() - e_.direction * row.axial_stress_Pa) * e_.section_m2, most = 1e-3 * largest_travel_m_;
        return std::clamp(missing_N / e_.axial_stiffness / (2.0 * e_.travel_time), -most, most);
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
        servo_ = state.servo;
        arrest_ = state.arrest;
        stop_ = state.stop;
        stages_ = state.stages;
        e_.stage = state.stage;
        result_.stages = state.stage_records;
        largest_travel_m_ = state.largest_travel_m;
        recorder_.go_back_to(state.record);
        result_.new_contacts = state.new_contacts;
        result_.shape_fallbacks = state.shape_fallbacks;
        result_.angular_momentum_loss = state.angular_momentum_loss;
        balanced_step_ = e_.step;
        passage_start_ = result_.steps;
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
    const double wanted_ = accuracy_of(residual_target(e_.setup.numerics, e_.setup.test.kind), e_.setup.test.kind);
    Servo servo_;
    Servo arrest_;   // of a test with stages, while it does not load
    StopRule stop_;
    StageCursor stages_;
    double largest_travel_m_ = 0.0;   // of a test with stages, so far
    ProgressReporter progress_;
    std::vector<Loading> states_;   // the oldest first
    double settled_Pa_ = 0.0;       // the peak whose passage was judged last
    long long first_steps_ = 0;     // of the first passage
    long long passage_start_ = 0;   // result_.steps when the passage under way began
    double passed_Pa_ = 0.0;        // strength of the passage before, and its limits
    PassageLimits passed_with_;
    const PassageLimits first_ = first_passage(e_.setup.numerics, e_.setup.test.kind);
    PassageLimits strict_ = first_;   // of the passage under way, until its peak
    long long balanced_step_ = e_.step;   // when the typical body was within the target last
};

}  // namespace

void load(Experiment& e, Recorder& recorder, TestResult& result) { Loader(e, recorder, result).run(); }

}  // namespace feldspar
