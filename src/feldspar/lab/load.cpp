// From the first moment of loading to the stop: steps, contacts, rate control, records (docs/theory/loading.md).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/foresee.hpp"
#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/lab/keep_test.hpp"
#include "feldspar/lab/observer.hpp"
#include "feldspar/lab/post_peak.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/lab/recorder.hpp"
#include "feldspar/lab/servo.hpp"
#include "feldspar/lab/stages.hpp"
#include "feldspar/lab/stop_rule.hpp"
#include "feldspar/lab/test_watch.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

// Tells the caller how the loading goes, at most a few times a second.
class ProgressReporter {
public:
    /// @param steps_before  made before this began
    ProgressReporter(const Experiment& e, long long steps_before)
        : e_(e), usual_(typical_steps(e)), steps_before_(steps_before) {}

    /// @param steps   of all passages so far
    /// @param in_all  that the test is now expected to take; 0: as is usual
    void loading(const HistoryRow& row, double peak_Pa, long long steps_made, double in_all) {
        if (!e_.control.progress) return;
        const double elapsed = seconds_since(start_);
        if (elapsed - last_ < 0.2) return;
        last_ = elapsed;
        const double steps = static_cast<double>(steps_made),
                     rate = elapsed > 0.0 ? static_cast<double>(steps_made - steps_before_) / elapsed : 0.0,
                     expected = in_all > 0.0 ? in_all : usual_;
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
    long long steps_before_;
    Clock::time_point start_ = Clock::now();
    double last_ = -1.0;
};

// What a watch sees.
class Sight final : public TestSight {
public:
    Sight(const Experiment& e, const TestResult& result) : e_(e), result_(result) {}
    const TestResult& so_far() const override { return result_; }
    std::vector<Vec2> displacements() const override {
        return mesh_displacements(e_.assembly, *result_.specimen, e_.assembly.nodes.displacement);
    }

private:
    const Experiment& e_;
    const TestResult& result_;
};

// Contacts between grains, looked after every few steps.
void maintain_contacts(Experiment& e, ContactFinder& finder, ShapeWatch& watch, TestResult& result, int steps) {
    const ContactFinder::Changes changes = finder.update(e.assembly, e.mass_factor);
    e.rate_control_J +=
        changes.kinetic_J + changes.elastic_J;  // heavier nodes took their speed along; contacts began with an overlap
    result.new_contacts += changes.made;
    const ShapeChoice shapes = watch.look(e.assembly, e.mass_factor);
    e.rate_control_J += shapes.kinetic_J;
    result.shape_fallbacks += static_cast<long long>(shapes.fallback_sides) * steps;
    if (shapes.fallback_sides > 0)
        result.angular_momentum_loss = std::max(result.angular_momentum_loss, fallback_moment_loss(e.assembly));
}

// What leads the loading, and goes back with the body.
struct Lead {
    ContactFinder finder;
    ShapeWatch watch;
    LoadingModeUpdate mode_update;
    RateControl control;
    Servo servo;
    Servo arrest;  // of a test with stages, while it does not load
    StopRule stop;
    StageCursor stages;
    double largest_travel_m = 0.0;        // of a test with stages, so far
    std::optional<double> given_speed{};  // by an observer, in place of the test's own
};

// Everything that loading changes: a test may go back to it and pass the strength again, more slowly.
struct Loading {
    ExperimentState body;
    Lead lead;
    std::vector<StageRecord> stage_records;
    Recorder::Mark record;
    int new_contacts;
    long long shape_fallbacks;
    double angular_momentum_loss;
    double load_Pa;  // magnitude
};

// The passages of the strength so far: what does not go back.
struct Passages {
    double settled_Pa = 0.0;      // the peak whose passage was judged last
    long long first_steps = 0;    // of the first passage
    long long passage_start = 0;  // TestResult::steps when the passage under way began
    double passed_Pa = 0.0;       // strength of the passage before, and its limits
    PassageLimits passed_with{};
    PassageLimits strict{};       // of the passage under way, until its peak
    long long balanced_step = 0;  // when the typical body was within the target last
    double supplied_J = 0.0;      // largest so far
};

constexpr double kBetweenStates = 1.1;  // growth of the load between states that are kept
constexpr std::size_t kStates = 2;
constexpr double kBeforePeak = 0.9;  // share of the peak from where it is passed again: there the estimated error begins to look
// Of the wanted error: what each of its two parts may take in the next passage, and by how much two strengths that are the same
// may differ.
constexpr double kAim = 0.4, kSame = 0.5;
// How much stricter one passage is than the one before at most, and any than the first; and by which both limits fall
// in what counts as a repeat.
constexpr double kMostStricter = 0.1, kStrictest = 0.03, kRepeat = 0.5;
// Passages, and steps as a multiple of those of the first one, after which the strength is taken as it is; the grade then says
// how sure it is.
constexpr int kMostPassages = 8;
constexpr long long kMostSteps = 4;
// Multiple of those steps after which a passage under way has its limits widened, in proportion to its own steps: a specimen that
// yields at constant load for ever would never be through. The grade then says how sure the strength is.
constexpr double kLongPassage = 20.0;
constexpr double kUsualPassages = 3.5;  // steps of a whole test over those of the first passage, for the time left
// How long a body out of balance is waited for at a platen at rest, in travel times of a wave. A crack that runs away has run out
// by then. What is not at rest fails slowly by itself, and may need a hundred travel times to lose a tenth of its load: the
// platen goes on, by this multiple of the wanted accuracy in a travel time, slowly enough that the strength does not notice.
constexpr double kRunOut = 5.0,
                 kFailsByItself = 0.01;  // R* of the typical body: a branch that softens quietly stays under control
constexpr double kGrowthFailing = 0.2;
constexpr double kServoShare =
    0.5;  // of the wanted accuracy: with half of it the branch changes by 5 % in strain at most (docs/decisions, servo control)
// A test with stages: the growth of the travel in a travel time with which a reversal of the volumetric strain is looked for; the
// share of the largest load from which on states are kept in a later stage; and how long a change of pressure takes that changes
// it altogether, in travel times.
constexpr double kGrowthSeen = 0.1, kKeptFrom = 0.5, kConfining = 30.0, kLeastConfining = 3.0;
constexpr double kRunaway = 1.0;  // of all that was ever supplied: energy of the motion that is not the loading's, and gap of the
                                  // balance, of a motion that feeds itself
constexpr double kPatience =
    100.0;  // travel times after which it goes on faster, in proportion: what creeps for ever is not waited for

class Loader {
public:
    Loader(Experiment& e, Recorder& recorder, TestResult& result)
        : e_(e),
          recorder_(recorder),
          result_(result),
          lead_{ContactFinder(e.assembly, 0.1 * mean_body_diameter(e.assembly)),
                ShapeWatch(e.assembly),
                LoadingModeUpdate(e.travel_time),
                RateControl(first_, e.travel_time),
                Servo(branch_is_followed(result) ? e.setup.test.control : LoadControl::displacement, kServoShare * wanted_,
                      e.travel_time, static_cast<std::size_t>(std::max(0, e.gauges.find(e.setup.test.control_gauge)))),
                Servo(LoadControl::dissipation, kServoShare * wanted_, e.travel_time),
                StopRule(e, result),
                StageCursor(e)} {}

    void run() {
        const int block = steps_per_row(e_.setup.numerics);
        TestKeeping* const keeping = e_.keeping;
        if (keeping != nullptr && keeping->goes_on(TestPart::loading)) {
            keeping->go_on([&](StateReader& reader) { go_on(reader); });
        } else {
            if (adaptive_ && lead_.stages.loads()) e_.change_speed(lead_.control.start(e_.platen_travel_m));
            const HistoryRow& first = recorder_.record(Phase::loading);
            if (lead_.stages.staged()) begin_stage(first_row());
            if (const auto reason =
                    lead_.stop.ended(first, lead_.stages.loads())) {  // the computed start may end at the maximum stress
                result_.stop_reason = *reason;
                return;
            }
        }
        progress_.emplace(e_, result_.steps);
        const Clock::time_point start = Clock::now();
        const double before_s = loading_s_;
        for (;;) {
            const bool stopped = e_.stopped();
            if (keeping != nullptr && keeping->due(stopped)) {
                loading_s_ = before_s + seconds_since(start);
                keeping->keep(TestPart::loading, [&](StateWriter& writer) { keep(writer); });
            }
            if (stopped) {
                result_.interrupted = true;
                result_.stop_reason = "interrupted by the user";
                break;
            }
            e_.run(block);
            result_.steps += block;
            try {
                maintain_contacts(e_, lead_.finder, lead_.watch, result_, block);
            } catch (const NumericalError& error) {
                throw NumericalError(fmt::format("{} at step {} (platen travel {:.3g} m): {}", error.what(), e_.step,
                                                 e_.platen_travel_m, cause_of_runaway()));
            }
            const HistoryRow& row = recorder_.record(Phase::loading);
            refuse_runaway(row);
            lead_.servo.observe(row, block);
            std::optional<std::string> reason = lead_.stop.ended(row, lead_.stages.loads(), lead_.servo.unloading());
            if (!reason && lead_.stages.staged()) reason = lead_.stages.stuck(row);
            progress_->loading(row, lead_.stop.peak(), result_.steps,
                               kUsualPassages * static_cast<double>(passages_.first_steps));
            if (TestWatch* const watch = e_.control.watch) {
                if (watch->due()) watch->see(Sight(e_, result_));
                if (watch->ended()) {
                    result_.stop_reason = kEndedByUser;
                    break;
                }
            }
            const double load = e_.direction * row.axial_stress_Pa;
            const bool past_peak = lead_.stages.loads() && lead_.stop.past_peak(load);
            if (adaptive_ && lead_.stages.loads() && !lead_.stop.steps_are_spent() &&
                (reason || past_peak || (unrest() > kRunOut && e_.method.reading != Reading::disc)) && passed_too_fast())
                continue;
            if (reason) {
                result_.stop_reason = *reason;
                break;
            }
            if (!adaptive_) {
                if (e_.control.observer == nullptr) continue;
                if (observe().stop) break;
                if (const double speed = lead_.given_speed.value_or(own_speed_); speed != e_.settings.speed)
                    e_.change_speed(speed);
                continue;
            }
            if (lead_.stages.loads()) keep_state(load);
            lead_.mode_update.observe(e_.assembly, e_.step, e_.platen_travel_m, lead_.stages.staged());
            const bool known = past_peak && settled();
            lead_.control.set_limits(known ? first_ : limits(load));
            if (lead_.stages.staged()) {
                if (!go_on_in_stages(row, block, known)) break;
                continue;
            }
            double speed = lead_.control.next(std::max(0.0, e_.settings.speed), recorder_.unbalanced(), force_scale(row),
                                              e_.platen_travel_m, slowest_growth());
            if (known && lead_.servo.on()) {  // in balance the body takes what the rate control gives; out of balance it fails,
                                              // and the servo leads
                const double allowed = lead_.servo.speed(e_.platen_travel_m);
                speed = lead_.control.balanced() ? std::max(speed, allowed) : allowed;
            }
            if (lead_.control.balanced()) passages_.balanced_step = e_.step;
            if (observe().stop) break;
            if (lead_.given_speed) speed = *lead_.given_speed;
            if (speed != e_.settings.speed) e_.change_speed(speed);
        }
        if (led_) {
            result_.test.stages.clear();
            for (const StageSpec& stage : gone_through_) result_.test.stages.push_back({{stage}});
        }
        if (!result_.stages.empty()) result_.stages.back().last_row = result_.history.size() - 1;
        result_.steps_to_peak = result_.steps - (e_.step - lead_.stop.peak_step());
        result_.ms_per_step =
            result_.steps > 0 ? 1e3 * (before_s + seconds_since(start)) / static_cast<double>(result_.steps) : 0.0;
    }

private:
    // A state to go back to. Its members stand where those of the live state do, so that its body is compared with the base
    // state, too.
    template <class Archive>
    static void keep_loading(Archive& archive, Loading& state) {
        with_members(state, archive);
    }

    // Everything that changes here and in what this leads; between two blocks of steps.
    template <class Archive>
    void keep_live(Archive& archive) {
        archive(e_.state(), lead_, passages_, loading_s_, recorder_);
        keep_course(archive, result_);
    }

    // The states to go back to stand first: they are read over the base state too.
    void keep(StateWriter& writer) {
        writer.write(states_.size());
        for (Loading& state : states_) keep_loading(writer, state);
        keep_live(writer);
    }

    void go_on(StateReader& reader) {
        std::size_t states = 0;
        reader.read(states);
        if (states > kStates) throw StateError("it has more states to go back to than a test keeps");
        for (std::size_t i = 0; i < states; ++i) {
            states_.push_back(present(0.0));
            keep_loading(reader, states_.back());
        }
        keep_live(reader);
    }

    Loading present(double load_Pa) const {
        return {e_.state(),
                lead_,
                result_.stages,
                recorder_.mark(),
                result_.new_contacts,
                result_.shape_fallbacks,
                result_.angular_momentum_loss,
                load_Pa};
    }

    // A motion that feeds itself ends here, at the next record: before the numbers run out, by the energy that nobody has
    // supplied.
    void refuse_runaway(const HistoryRow& row) {
        passages_.supplied_J = std::max(passages_.supplied_J, std::abs(row.energy.supplied()));
        if (!std::isfinite(row.residual) || !std::isfinite(row.axial_stress_Pa) || !std::isfinite(row.energy.residual()))
            throw NumericalError(fmt::format("a force is not a number at step {} (axial strain {:.3g}), first {}: {}", e_.step,
                                             row.axial_strain, fastest_place(), cause_of_runaway()));
        if (row.kinetic_deviation > kRunaway * passages_.supplied_J &&
            std::abs(row.energy.residual()) > kRunaway * passages_.supplied_J)
            throw NumericalError(fmt::format(
                "the body moves with {:.3g} J, more than was ever supplied ({:.3g} J), at step {} (axial strain {:.3g}), and "
                "fastest {}: {}",
                row.kinetic_deviation, passages_.supplied_J, e_.step, row.axial_strain, fastest_place(), cause_of_runaway()));
    }

    // Where a node has no finite velocity, else where it is largest.
    std::string fastest_place() const {
        const Nodes& nodes = e_.assembly.nodes;
        int fastest = 0;
        for (int n = 0; n < nodes.count(); ++n) {
            const double speed = norm(nodes.velocity[n]);
            if (!std::isfinite(speed)) {
                fastest = n;
                break;
            }
            if (speed > norm(nodes.velocity[fastest])) fastest = n;
        }
        const Vec2 at = nodes.reference[fastest];
        return fmt::format("at ({:.4g}, {:.4g}) mm", 1e3 * at.x, 1e3 * at.y);
    }

    std::string cause_of_runaway() const {
        const NumericsSpec& n = e_.setup.numerics;
        if (n.kind == NumericsKind::dynamic && n.time_step_s)
            return "the time step may be too large for what has changed since it was judged; without numerics.time_step 0.8 of "
                   "the stable one is taken";
        if (n.mass_factor)
            return "numerics.mass_factor may be too small for what has changed since it was judged; without the key it is 1 + "
                   "damping";
        return "the motion has become unstable, most likely where a grain is crushed or a contact is very stiff (Kn against E "
               "over the size of a grain)";
    }

    // Keeps the states at which the load has grown by a tenth: the last ones, so that one lies before the peak, whenever that
    // comes.
    void keep_state(double load_Pa) {
        if (lead_.stages.staged() && load_Pa < kKeptFrom * lead_.stop.peak()) return;
        if (!(load_Pa > 0.0) || load_Pa < kBetweenStates * (states_.empty() ? 0.0 : states_.back().load_Pa)) return;
        if (states_.size() == kStates) states_.erase(states_.begin());
        states_.push_back(present(load_Pa));
    }

    // Of the passage under way. On the plateau of a confined specimen, below a strength that is known, it may be out of balance
    // by as much as the load is below it, and the load may grow by that in a travel time: more would be needed to show a strength
    // that is none.
    PassageLimits limits(double load_Pa) const {
        if (lead_.stages.staged() && !lead_.stages.loads()) return first_;  // no strength is passed
        if (lead_.stages.staged() && lead_.stages.now().end == StageEnd::reversal)
            return {passages_.strict.residual, std::min(passages_.strict.growth, kGrowthSeen)};
        if (lead_.stages.staged() && passages_.settled_Pa > 0.0 && settled()) return first_;  // below a strength that is known
        if (passages_.first_steps == 0) return passages_.strict;
        const double wider = std::max(1.0, static_cast<double>(result_.steps - passages_.passage_start) /
                                               (kLongPassage * static_cast<double>(passages_.first_steps)));
        const double below = e_.confined() && settled() ? std::max(0.0, 1.0 - load_Pa / lead_.stop.peak()) : 0.0;
        return {std::min(first_.residual, wider * passages_.strict.residual + below / e_.method.rate.residual_share),
                std::min(first_.growth, wider * passages_.strict.growth + below)};
    }

    // How fast the platen goes on at least, as a growth of its travel in a travel time of a wave: while the specimen fails by
    // itself, and while a confined one is in balance to its part of the wanted error. It yields on a plateau of many events, any
    // of which may have made the limits stricter than that, and the wait for them would be without end.
    double slowest_growth() const {
        const double slow = kGrowthFailing * wanted_;
        if (e_.confined() && e_.method.rate.residual_share * lead_.control.residual() < kAim * wanted_) return slow;
        return lead_.control.residual() > kFailsByItself && unrest() > kRunOut ? slow * std::max(1.0, unrest() / kPatience) : 0.0;
    }

    // Beside which unbalanced forces are small, N. What the dead loads leave out of balance says nothing while the load is small
    // beside them.
    double force_scale(const HistoryRow& row) const {
        return std::max(std::abs(row.axial_stress_Pa) * e_.section_m2, 0.5 * e_.dead_load_N);
    }

    // How long the typical body has been out of balance, in travel times of a wave.
    double unrest() const { return static_cast<double>(e_.step - passages_.balanced_step) / e_.travel_time; }

    // Goes back before the peak, with stricter limits, if the estimated error of the strength is larger than what is wanted.
    bool passed_too_fast() {
        if (lead_.stages.staged() && !lead_.stop.peak_in_stage())
            passages_.settled_Pa = lead_.stop.peak();  // where the stage turned, not where the rock failed
        if (settled() || states_.empty()) return false;
        passages_.settled_Pa = lead_.stop.peak();
        if (result_.passages == 1) passages_.first_steps = result_.steps;
        QuasiStaticEvidence& evidence = result_.evidence;
        evidence.confirmed = false;
        const QuasiStaticEvidence seen = judge(result_);
        if (seen.error_estimate <= wanted_) return false;
        const auto by = [](const PassageLimits& l, const PassageLimits& r) {
            return std::max(l.residual / r.residual, l.growth / r.growth);
        };
        if (passages_.passed_Pa > 0.0 && by(passages_.strict, passages_.passed_with) <=
                                             kRepeat) {  // a repeat: what did not change the strength is no error of it
            evidence.peak_change_at_third = lead_.stop.peak() / passages_.passed_Pa - 1.0;
            evidence.confirmed = std::abs(evidence.peak_change_at_third) < kSame * wanted_;
        }
        if (evidence.confirmed) return false;
        if (result_.passages >= kMostPassages || result_.steps > kMostSteps * passages_.first_steps) return false;
        passages_.passed_Pa = lead_.stop.peak();
        passages_.passed_with = passages_.strict;
        const double of_residual = e_.method.rate.residual_share * seen.residual_median,
                     of_growth = seen.error_estimate - of_residual;
        passages_.strict.residual =
            std::max(kStrictest * first_.residual,
                     passages_.strict.residual * std::clamp(kAim * wanted_ / of_residual, kMostStricter, 1.0));
        passages_.strict.growth = std::max(kStrictest * first_.growth,
                                           passages_.strict.growth * std::clamp(kAim * wanted_ / of_growth, kMostStricter, 1.0));
        pass_again();
        return true;
    }

    void pass_again() {
        ++result_.passages;
        while (states_.size() > 1 && states_.back().load_Pa > kBeforePeak * lead_.stop.peak()) states_.pop_back();
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
        result_.stages.push_back({lead_.stages.kind(), lead_.stages.group_number(), lead_.stages.pass(), row, row, {}});
        lead_.stages.begin(result_.history[row]);
        lead_.stop.stage_began();
        states_.clear();
        gone_through_.push_back(lead_.stages.now());
    }

    // Shows an observer the state of the last row, and does what it orders, but for the stage. @param stage_ended  why the stage
    // under way has come to its end at this row
    TestOrders observe(const std::optional<std::string>& stage_ended = {}) {
        if (e_.control.observer == nullptr) return {};
        const TestView view{result_,         e_.assembly,    e_.gauges.specs(), e_.platen_travel_m,  e_.settings.speed,
                            e_.settings.dt,  e_.travel_time, e_.stage,          lead_.stages.kind(), stage_ended,
                            result_.passages};
        TestOrders orders = e_.control.observer->look(view);
        for (const TestOrders::Pressure& order : orders.pressures) press(order);
        for (const TestOrders::Motion& order : orders.motions) e_.change_motion(fixture_called(order.fixture), order.motion);
        if (!orders.motions.empty()) lead_.mode_update.forget();
        if (orders.stage && !lead_.stages.staged())
            throw InputError(
                {.key = "stage"}, "a stage is ordered of a test that has none",
                "a test with stages, or an observer that says with which one the loading begins (TestObserver::begins)");
        if (orders.pace == TestOrders::Pace::given && !std::isfinite(orders.speed))
            throw InputError({.key = "speed"}, "the speed that is ordered is not a number",
                             "metres a step, or m/s with dynamic numerics");
        if (orders.pace != TestOrders::Pace::as_before)
            lead_.given_speed = orders.pace == TestOrders::Pace::given ? std::optional(orders.speed) : std::nullopt;
        if (orders.stop) result_.stop_reason = *orders.stop;
        return orders;
    }

    void press(const TestOrders::Pressure& order) {
        if (!(order.pressure_Pa >= 0.0) || !std::isfinite(order.pressure_Pa))
            throw InputError({.key = "pressure"}, fmt::format("{} Pa is no pressure that can act", order.pressure_Pa),
                             "0 or more");
        bool found = false;
        std::string known;
        for (DeadLoad& load : e_.assembly.dead_loads) {
            known += (known.empty() ? "" : ", ") + load.name;
            if (!order.fixture.empty() && load.name != order.fixture) continue;
            load.pressure_Pa = order.pressure_Pa;
            found = true;
        }
        if (!found)
            throw InputError({.key = "pressure"},
                             fmt::format("no fixture '{}' presses with a pressure that could change", order.fixture),
                             known.empty() ? "a test with a pressure" : known);
    }

    std::size_t fixture_called(const std::string& name) const {
        std::string known;
        for (std::size_t i = 0; i < e_.assembly.fixtures.size(); ++i) {
            if (e_.assembly.fixtures[i].name == name) return i;
            known += (known.empty() ? "" : ", ") + e_.assembly.fixtures[i].name;
        }
        throw InputError({.key = "fixture"}, fmt::format("the test has no fixture '{}' that imposes a motion", name), known);
    }

    // Goes to the stage that an observer has ordered.
    void take(const StageSpec& stage) {
        require_stage(e_, stage);
        e_.stages.push_back({{stage}});
        lead_.stages.go_to_last();
        led_ = true;
    }

    // What the loading motion does until the next row of a test with stages. @return false when the last stage has ended
    bool go_on_in_stages(const HistoryRow& row, int block, bool known) {
        const double load = e_.direction * row.axial_stress_Pa;
        lead_.largest_travel_m = std::max(lead_.largest_travel_m, e_.platen_travel_m);
        double pace = lead_.control.next(std::max(0.0, lead_.stages.sense() * e_.settings.speed), recorder_.unbalanced(),
                                         force_scale(row), lead_.largest_travel_m, slowest_growth());
        if (lead_.control.balanced()) passages_.balanced_step = e_.step;
        const bool past_peak = lead_.stages.loads() && lead_.stop.past_peak(load);
        lead_.arrest.observe(row, block);
        auto why = lead_.stages.ended(row, lead_.stop.peak(), past_peak, lead_.control.residual() / first_.residual);
        TestOrders orders;
        if (!why) {
            orders = observe();
            if (orders.stop) return false;
            if (orders.stage) why = "another stage was ordered";
        }
        if (why) {
            // A stage that ends while its specimen fails, as by its widening, has passed a strength too.
            const bool fails =
                lead_.stages.loads() && (!lead_.control.balanced() || load < (1.0 - kSame * wanted_) * lead_.stop.stage_peak());
            if (fails && passed_too_fast()) return true;
            result_.stages.back().ended = *why;
            result_.stages.back().last_row = result_.history.size() - 1;
            if (lead_.stages.failed(lead_.stop.stage_peak(), e_.setup.test.stop_fraction * lead_.stop.peak())) {
                e_.change_speed(0.0);
                result_.stop_reason = lead_.stop.fallen();
                return false;
            }
            if (!orders.stage) orders = observe(why);
            if (orders.stop) return false;
            if (orders.stage) {
                take(*orders.stage);
            } else if (!lead_.stages.next()) {
                e_.change_speed(0.0);
                result_.stop_reason = "the last stage is done: " + *why;
                return false;
            }
            ++e_.stage;
            begin_stage(result_.history.size() - 1);
            lead_.mode_update.forget();
            pace = lead_.control.start(lead_.largest_travel_m);
            lead_.given_speed.reset();
            if (orders.pace == TestOrders::Pace::given) lead_.given_speed = orders.speed;
            known = false;
        }
        double speed = lead_.stages.sense() * pace;
        if (known && lead_.servo.on()) {
            const double allowed = lead_.servo.speed(e_.platen_travel_m);
            speed = lead_.control.balanced() ? std::max(speed, allowed) : allowed;
        }
        if (lead_.stages.kind() == StageKind::confine) speed = confine(row, block);
        // What fails while it is unloaded, or pressed, is taken back by the loading motion: at rest it would run away.
        if (lead_.stages.kind() == StageKind::unload || lead_.stages.kind() == StageKind::confine)
            speed = std::min(speed, -lead_.arrest.arrest(lead_.largest_travel_m));
        const double most = lead_.stages.approach_m(lead_.stop.peak()) / (block * e_.settings.dt);
        if (std::abs(speed) > most && lead_.stages.sense() != 0.0 && speed * lead_.stages.sense() > 0.0)
            speed = lead_.stages.sense() * most;
        if (lead_.given_speed) speed = *lead_.given_speed;
        if (speed != e_.settings.speed) e_.change_speed(speed);
        return true;
    }

    // A part of the change of pressure, unless the body is out of balance. @return the speed with which the loading motion
    // follows
    double confine(const HistoryRow& row, int block) {
        const StageSpec& stage = lead_.stages.now();
        for (std::size_t i = 0; i < e_.assembly.dead_loads.size(); ++i) {
            double& pressure = e_.assembly.dead_loads[i].pressure_Pa;
            const double change = stage.sigma3_Pa - lead_.stages.begun_Pa(i),
                         whole = std::max(stage.sigma3_Pa, lead_.stages.begun_Pa(i));
            if (change == 0.0 || !lead_.stages.changes(i)) continue;
            const double times = std::max(kLeastConfining, kConfining * std::abs(change) / whole);
            const double share = lead_.control.balanced() ? 1.0 : unrest() > kRunOut ? kGrowthFailing : 0.0;
            const double next = pressure + share * change * block * e_.settings.dt / (times * e_.travel_time);
            pressure = change > 0.0 ? std::min(next, stage.sigma3_Pa) : std::max(next, stage.sigma3_Pa);
        }
        if (stage.keep == ConfineKeep::motion) return 0.0;
        const double missing_N = (lead_.stages.begun_load_Pa() - e_.direction * row.axial_stress_Pa) * e_.section_m2,
                     most = 1e-3 * lead_.largest_travel_m;
        return std::clamp(missing_N / e_.axial_stiffness / (2.0 * e_.travel_time), -most, most);
    }

    bool settled() const { return lead_.stop.peak() <= (1.0 + kSame * wanted_) * passages_.settled_Pa; }

    void go_back_to(const Loading& state) {
        e_.state() = state.body;
        lead_ = state.lead;
        result_.stages = state.stage_records;
        recorder_.go_back_to(state.record);
        result_.new_contacts = state.new_contacts;
        result_.shape_fallbacks = state.shape_fallbacks;
        result_.angular_momentum_loss = state.angular_momentum_loss;
        passages_.balanced_step = e_.step;
        passages_.passage_start = result_.steps;
        passages_.settled_Pa = 0.0;
    }

    Experiment& e_;
    Recorder& recorder_;
    TestResult& result_;
    const bool adaptive_ = e_.setup.numerics.kind == NumericsKind::adaptive;
    const double wanted_ = accuracy_of(residual_target(e_.setup.numerics, e_.setup.test.kind), e_.setup.test.kind);
    const PassageLimits first_ = first_passage(e_.setup.numerics, e_.setup.test.kind);
    Lead lead_;
    std::vector<Loading> states_;  // the oldest first
    Passages passages_{.strict = first_, .balanced_step = e_.step};
    double loading_s_ = 0.0;                      // before the program was ended, if it was
    const double own_speed_ = e_.settings.speed;  // of numerics that keep one
    std::vector<StageSpec> gone_through_;
    bool led_ = false;  // by the stages that an observer orders
    std::optional<ProgressReporter> progress_;
};

}  // namespace

void load(Experiment& e, Recorder& recorder, TestResult& result) { Loader(e, recorder, result).run(); }

}  // namespace feldspar
