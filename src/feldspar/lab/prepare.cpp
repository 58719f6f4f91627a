// From the unloaded body to the first moment of loading (docs/theory/loading.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/keep_test.hpp"
#include "feldspar/lab/stages.hpp"

namespace feldspar {
namespace {

constexpr double kTolerance = 1e-5;         // mean |F| / mean |contact force| of the relaxed body
constexpr double kOnTheWay = 1e-3;          // the same for a state that is only scaled or corrected next
constexpr double kBelowDamage = 0.98;       // of the first damage: where the elastic phase ends
constexpr long long kMaximumSteps = 20000;  // of a relaxation; the short slope of examples/slope takes some 2,100
constexpr double kMaximumTravelTimes =
    100.0;  // of a wave: in a large specimen rest comes after as many of them, not after as many steps

void relax_or_throw(Experiment& e, double tolerance = kTolerance) {
    constexpr long long kTold = 100;  // steps from word to word: a large specimen takes an hour to come to rest
    long long made = 0;
    const auto look = [&] {  // before each step
        if (e.control.progress && made % kTold == 0)
            e.control.progress({.stage = "elastic start", .step = e.preparation_steps + made});
        ++made;
        return e.stopped();
    };
    const long long most = std::max(kMaximumSteps, std::llround(kMaximumTravelTimes * e.travel_time / e.settings.dt));
    const Relaxation r = relax(e.assembly, e.team, Strength::unlimited, tolerance, most, look, e.settings.dt);
    e.preparation_steps += r.steps;
    if (e.stopped()) throw Interrupted();
    if (!r.converged)
        throw NumericalError(fmt::format("the elastic start did not relax: residual {:.3g} after {} steps, wanted {:.3g}",
                                         r.residual, r.steps, tolerance));
}

// What a node of a body takes of an affine field: a rigid body does not turn, a plate moves where it may.
Vec2 share_of_field(const Assembly& assembly, const Body& body, int node, Vec2 field) {
    switch (body.kind) {
        case BodyKind::flexible:
            return field;
        case BodyKind::rigid:
            return node == body.centre_node ? field : Vec2{};
        case BodyKind::plate:
            return {assembly.nodes.inverse_mass[node].x != 0.0 ? field.x : 0.0, 0.0};
    }
    return {};
}

// Where the field leaves x alone: at the node that a row of nodes holds, else in the middle of the width.
double fixed_x(const Assembly& assembly, const Box& box) {
    for (const Body& body : assembly.bodies)
        for (const int n : body.nodes())
            if (body.kind == BodyKind::flexible && assembly.nodes.inverse_mass[n].x == 0.0) return assembly.nodes.reference[n].x;
    return 0.5 * (box.lower.x + box.upper.x);
}

// Moves the nodes by what `set_motion` writes into their velocities. The contacts follow the motion as they do in a step, so that
// gaps that it opens or closes between rigid bodies and at plates are felt.
template <class SetMotion>
void move_by(Experiment& e, double travel_m, SetMotion&& set_motion) {
    Nodes& nodes = e.assembly.nodes;
    const Array<Vec2> velocity = nodes.velocity;
    set_motion();
    StepSettings elastic;
    elastic.strength = Strength::unlimited;
    contact_forces(e.assembly, {0, static_cast<int>(e.assembly.contacts.size())}, elastic, -1);
    for (int n = 0; n < nodes.count(); ++n) nodes.displacement[n] += nodes.velocity[n];
    nodes.velocity = velocity;
    e.platen_travel_m += travel_m;
}

// Moves everything by an affine field: shortening by `travel_m` over the height, widening by nu.
void add_affine(Experiment& e, double travel_m) {
    Assembly& assembly = e.assembly;
    Nodes& nodes = assembly.nodes;
    const Box box = bounding_box(nodes.reference);
    const Vec2 origin = {fixed_x(assembly, box), box.lower.y};
    const double strain = -e.direction * travel_m / e.length_m;
    move_by(e, travel_m, [&] {
        for (const Body& body : assembly.bodies)
            for (const int n : body.nodes()) {
                const Vec2 x = nodes.reference[n] - origin;
                nodes.velocity[n] = share_of_field(assembly, body, n, {-e.elastic_guess.nu * strain * x.x, strain * x.y});
            }
        for (const Fixture& fixture : assembly.fixtures)
            if (fixture.moves())
                for (const int node : fixture.nodes) nodes.velocity[node].y = fixture.motion.y * travel_m;
    });
}

double platen_force(const Experiment& e) { return loading_reaction(e.assembly); }

// Stiffness, travel time and damping as the relaxed body shows them.
void learn_from(Experiment& e, double force_change, double travel_change) {
    if (!e.method.start.stays_in_touch || travel_change == 0.0) return;
    const double stiffness = std::abs(force_change / travel_change);
    e.travel_time *= std::sqrt(e.axial_stiffness / stiffness);
    e.axial_stiffness = stiffness;
}

void go_to(Experiment& e, const BodyState& state) {
    restore(e.assembly, state);
    e.platen_travel_m = state.platen_travel_m;
}

// B = change of displacement per platen travel between two relaxed states.
void set_loading_mode(Experiment& e, const BodyState& from, const BodyState& to) {
    const double travel = to.platen_travel_m - from.platen_travel_m;
    Nodes& nodes = e.assembly.nodes;
    for (int n = 0; n < nodes.count(); ++n)
        nodes.loading_mode[n] = (1.0 / travel) * (to.displacement_m[n] - from.displacement_m[n]);
    e.impose_motion();
}

// The factor of superpose() at which the stress reaches the maximum that the user has set; infinite without one.
double factor_at_maximum(const Experiment& e, double force_at_base, double force_now) {
    if (!e.setup.test.maximum_stress_Pa) return std::numeric_limits<double>::infinity();
    const double most = *e.setup.test.maximum_stress_Pa * e.section_m2, base = std::abs(force_at_base);
    return (most - base) / (std::abs(force_now) - base);
}

// The same at which the first stage of a test ends, or of one that does not load first, at which the specimen is just in touch.
// @param before  what the end of the stage looks at, at the base
double factor_at_first_stage(const Experiment& e, double before, double damage_factor) {
    constexpr double kInTouch = 0.01;  // of the first damage
    if (e.stages.empty()) return std::numeric_limits<double>::infinity();
    const StageSpec& first = e.stages.front().stages.front();
    if (first.kind != StageKind::load) return kInTouch * damage_factor;
    if (first.end == StageEnd::share_of_peak) return std::numeric_limits<double>::infinity();
    const double change = stage_quantity(e, first) - before,
                 wanted = first.counts != StageValue::reached ? std::copysign(first.value, change) : first.value - before;
    const double factor = wanted / change;
    return factor > 0.0
               ? factor
               : std::numeric_limits<double>::infinity();  // no end of this kind, or one that the loading moves away from
}

double quantity_at_base(const Experiment& e) {
    return e.stages.empty() ? 0.0 : stage_quantity(e, e.stages.front().stages.front());
}

// Whether the state stands where the elastic phase ends: at the maximum stress, or just below the first damage at a further
// factor.
bool is_end_of_elastic_phase(double damage_factor, double nearly, double maximum_factor) {
    return damage_factor > 1.0 && (damage_factor < nearly || std::abs(maximum_factor - 1.0) < 1e-3);
}

// Contacts between grains that are broken before the test, perhaps open: the answer is not linear.
bool has_cracks(const Assembly& assembly) {
    return std::any_of(assembly.contacts.begin(), assembly.contacts.end(), [&](const Contact& contact) {
        return !contact.plate && assembly.bonds.damage[assembly.points[contact.first_point].state] >= 1.0;
    });
}

// Axial loading of the relaxed state `base` up to the maximum stress or just below the first damage; sets B. Platens that stay in
// touch.
void elastic_loading(Experiment& e, const BodyState& base) {
    const double force_before = platen_force(e), quantity_before = quantity_at_base(e);
    add_affine(e, 1e-5 * e.length_m);
    relax_or_throw(e, kOnTheWay);
    learn_from(e, platen_force(e) - force_before, e.platen_travel_m - base.platen_travel_m);
    for (int attempt = 0; attempt < 4; ++attempt) {
        const BodyState reached = capture(e.assembly, e.platen_travel_m);
        const double factor = first_damage(e.assembly, base, reached);
        if (!std::isfinite(factor)) throw NumericalError("no contact point comes closer to failure when the specimen is loaded");
        const double most =
            std::min(factor_at_maximum(e, force_before, platen_force(e)), factor_at_first_stage(e, quantity_before, factor));
        if (attempt > 0 && is_end_of_elastic_phase(factor, 1.05, most)) break;
        go_to(e, superpose(base, reached, std::min(kBelowDamage * factor, most)));
        relax_or_throw(e);
    }
    if (has_cracks(e.assembly)) {  // they may have slid: not beyond the first damage
        const BodyState reached = capture(e.assembly, e.platen_travel_m);
        if (const double factor = first_damage(e.assembly, base, reached); factor <= 1.0) {
            go_to(e, superpose(base, reached, 0.9 * factor));
            relax_or_throw(e);
        }
    }
    set_loading_mode(e, base, capture(e.assembly, e.platen_travel_m));
}

// Moves only what loads.
void move_fixtures(Experiment& e, double travel_m) {
    Nodes& nodes = e.assembly.nodes;
    move_by(e, travel_m, [&] {
        std::fill(nodes.velocity.begin(), nodes.velocity.end(), Vec2{});
        for (const Fixture& fixture : e.assembly.fixtures)
            for (const int node : fixture.nodes)
                nodes.velocity[node] =
                    travel_m * Vec2{fixture.imposed.x * fixture.motion.x, fixture.imposed.y * fixture.motion.y};
    });
}

// Quarter of the loading mode's period over that of a bar's quarter wave: for a bar the time in which a wave crosses it (L17).
void learn_time_of_mode(Experiment& e, double stiffness) {
    const Nodes& nodes = e.assembly.nodes;
    double inertia = 0.0;
    for (const Body& body : e.assembly.bodies)
        if (body.kind != BodyKind::plate)
            for (const int n : body.nodes()) inertia += nodes.mass[n] * dot(nodes.loading_mode[n], nodes.loading_mode[n]);
    if (!(stiffness > 0.0) || !(inertia > 0.0))
        throw NumericalError("the specimen does not resist the loading: nothing holds it, or nothing presses on it");
    e.axial_stiffness = stiffness;
    e.travel_time = std::sqrt(3.0 * inertia / stiffness);
}

// A slender specimen carries little load with large forces inside: what is small beside these may not be small beside the load.
void balance(Experiment& e) {
    constexpr double kEnough = 5e-4, kLeast = 1e-7;
    for (double tolerance = 0.3 * kTolerance; tolerance > kLeast; tolerance *= 0.3) {
        const Reactions r = reactions(e.assembly);
        if (std::abs(r.loading - r.rest) < kEnough * std::abs(r.loading)) return;
        relax_or_throw(e, tolerance);
    }
}

// A first motion; where the specimen gives way without force, because open joints close, a larger one, until it resists.
template <class Move, class Settle>
BodyState first_motion(Experiment& e, double first_m, double force_unloaded, Move move, Settle settle) {
    constexpr int kMost = 12;          // doublings: an opening of up to 4000 times the first motion
    constexpr double kResists = 0.01;  // of what a body without joints would
    move(first_m);
    BodyState reached = settle();
    if (!has_cracks(e.assembly)) return reached;
    for (int k = 0; k < kMost && std::abs(platen_force(e) - force_unloaded) < kResists * e.axial_stiffness * first_m; ++k) {
        first_m *= 2.0;
        move(first_m);
        reached = settle();
    }
    return reached;
}

// Where contacts close on the way the answer is not linear, so scale and relax several times; B from the last two states. Beside
// dead loads the first motion is small against them: a specimen that they alone hold may slide.
void elastic_contacts(Experiment& e) {
    constexpr double kLargestScale = 20.0, kHolds = 0.8;  // of a round; share of the load that a linear body would have gained
    constexpr double kFirstStrain = 2e-5, kFirstLoad = 0.02;  // the first motion; load that it brings about, over the dead loads
    const BodyState unloaded = capture(e.assembly, e.platen_travel_m);
    const double force_unloaded = platen_force(e), quantity_unloaded = quantity_at_base(e);
    const auto settle = [&](double tolerance = kTolerance) {
        relax_or_throw(e, tolerance);
        if (e.method.start.time_of_mode && tolerance == kTolerance) balance(e);
        return capture(e.assembly, e.platen_travel_m);
    };
    double first_m = kFirstStrain * e.length_m;
    if (e.has_dead_loads()) first_m = std::min(first_m, kFirstLoad * e.dead_load_N / e.axial_stiffness);
    const auto move = [&](double travel_m) {
        e.method.start.strained_evenly ? add_affine(e, travel_m) : move_fixtures(e, travel_m);
    };
    BodyState reached = first_motion(e, first_m, force_unloaded, move, [&] { return settle(kOnTheWay); });
    for (int round = 0; round < 6; ++round) {
        const double factor = first_damage(e.assembly, unloaded, reached);
        if (!std::isfinite(factor))
            throw NumericalError(
                "no contact point comes closer to failure when the specimen is loaded: its fixtures do not strain it");
        const double most =
            std::min(factor_at_maximum(e, force_unloaded, platen_force(e)), factor_at_first_stage(e, quantity_unloaded, factor));
        if (round > 0 && is_end_of_elastic_phase(factor, 1.04, most)) break;
        const double scale = std::min({kBelowDamage * factor, most, kLargestScale}), gained = platen_force(e) - force_unloaded;
        const BodyState before = reached;
        go_to(e, superpose(unloaded, reached, scale));
        reached = settle(kOnTheWay);
        if (e.has_dead_loads() &&
            platen_force(e) - force_unloaded < kHolds * scale * gained) {  // it slides: more motion brings no more load
            go_to(e, before);
            reached = before;
            break;
        }
    }
    reached = settle();
    if (first_damage(e.assembly, unloaded, reached) <= 1.0) {  // the rounds did not settle below the first damage
        go_to(e, superpose(unloaded, reached, 0.9 * first_damage(e.assembly, unloaded, reached)));
        reached = settle();
    }
    if (!e.stages.empty()) {  // the rounds saw the load of a body that was not yet in balance
        const double most = factor_at_first_stage(e, quantity_unloaded, first_damage(e.assembly, unloaded, reached));
        if (most < 1.0) {
            go_to(e, superpose(unloaded, reached, most));
            reached = settle();
        }
    }
    go_to(e, superpose(unloaded, reached, 0.95));
    const BodyState below = settle();
    const double force_below = platen_force(e);
    go_to(e, reached);
    relax_or_throw(e);
    set_loading_mode(e, below, capture(e.assembly, e.platen_travel_m));
    const double force_change = platen_force(e) - force_below, travel_change = reached.platen_travel_m - below.platen_travel_m;
    if (e.method.start.time_of_mode)
        learn_time_of_mode(e, force_change / travel_change);
    else
        learn_from(e, force_change, travel_change);
}

// Isotropic stress by superposition: lateral pressure, and platen travel until the platens carry the same stress.
void consolidate_elastically(Experiment& e) {
    const double target = e.setup.test.sigma3_Pa * e.section_m2;
    e.set_dead_loads(1.0);
    double tolerance =
        kOnTheWay;  // until the platens are right; a loose state moves on when it is relaxed in full, so both are asked then
    relax_or_throw(e, tolerance);
    for (int round = 0; round < 12; ++round) {
        const double missing = target - platen_force(e);
        if (round > 0 && std::abs(missing) < 1e-3 * target) {  // what the relaxation leaves moving is of this size
            if (tolerance == kTolerance) return;
            tolerance = kTolerance;
            relax_or_throw(e, tolerance);
            continue;
        }
        add_affine(e, missing / e.axial_stiffness);
        const double before = target - missing, travel = missing / e.axial_stiffness;
        relax_or_throw(e, tolerance);
        if (round == 0) learn_from(e, platen_force(e) - before, travel);
    }
    relax_or_throw(e);
}

// Dead loads with the real law: they follow a ramp of many travel times, then wait for rest. Of a confined specimen the platens
// follow by a servo, so that the stress is isotropic; else the fixtures rest. From where the ramp stands.
void bring_up_dead_loads(Experiment& e) {
    const double target = e.confined() ? e.setup.test.sigma3_Pa * e.section_m2 : e.dead_load_N;
    const double period = e.travel_time / e.settings.dt;  // in steps
    const long long ramp = std::llround(30.0 * period), most = 40 * ramp;
    const double already = e.ramp.already;
    for (long long& k = e.ramp.step;; k += 10) {
        const bool stopped = e.stopped();
        if (e.keeping != nullptr && e.keeping->due(stopped))
            e.keeping->keep(TestPart::preparation, [&](StateWriter& writer) { writer.write(e.state()); });
        if (stopped) throw Interrupted();
        const double share = std::min(1.0, already + (1.0 - already) * static_cast<double>(k) / static_cast<double>(ramp));
        e.set_dead_loads(share);
        const double force = platen_force(e);
        if (e.confined()) e.change_speed((share * target - force) / e.axial_stiffness / (2.0 * e.travel_time));
        e.run(10);
        e.preparation_steps += 10;
        if (!std::isfinite(force)) throw NumericalError("a force is not a number during the consolidation");
        if (e.control.progress && k % 100 == 0)
            e.control.progress({.stage = "consolidation", .step = k, .axial_stress_Pa = e.stress(force)});
        const auto [loading, rest] = reactions(e.assembly);
        const double mean = 0.5 * (loading + rest);  // which is reported
        const bool there = !e.confined() || std::abs(mean - target) < 2e-3 * target;
        if (share == 1.0 && there && unbalanced_force(e.assembly) < 0.01 * target) break;
        if (k > most)
            throw NumericalError(
                e.confined()
                    ? "the specimen does not come to rest under the isotropic stress: it fails before it is sheared"
                    : "the specimen does not come to rest under its pressures and its weight: it fails before it is loaded");
    }
    e.change_speed(0.0);
}

// @param already  share of the dead loads that acts already
void consolidate_by_ramp(Experiment& e, double already = 0.0) {
    e.ramp = {.step = 0, .already = already, .travel_m = e.ramp.travel_m};
    bring_up_dead_loads(e);
}

// The state when the loading starts, for the history.
void note_consolidated(Experiment& e) {
    const Reactions reactions = feldspar::reactions(e.assembly);
    const StoredEnergy stored = stored_energy(e.assembly, 0.0);
    HistoryRow& row = e.consolidated;
    row.step = e.step;
    row.platen_displacement_m = e.direction * e.platen_travel_m;
    row.axial_strain = row.platen_displacement_m / e.length_m;
    row.axial_strain_gauge = e.gauge.axial(e.assembly);
    row.lateral_strain_gauge = e.gauge.lateral(e.assembly);
    row.stress_top_Pa = e.stress(reactions.loading);
    row.stress_bottom_Pa = e.stress(reactions.rest);
    row.axial_stress_Pa = 0.5 * (row.stress_top_Pa + row.stress_bottom_Pa);
    row.sigma3_Pa = e.confining_Pa();
    row.energy.elastic_grains = stored.grains_J;
    row.energy.elastic_contacts = stored.contacts_J;
    row.energy.elastic_start = stored.grains_J + stored.contacts_J;
    row.gauges = e.gauges.read(e.assembly, row.energy);
}

// Does the state under dead loads stay below the first damage?
bool consolidated_is_elastic(const Experiment& e, const BodyState& unloaded) {
    return first_damage(e.assembly, unloaded, capture(e.assembly, e.platen_travel_m)) > 1.0;
}

void forget_relaxation_work(Experiment& e) {
    for (BodyWork& work : e.assembly.body_work) work = {};
    for (auto* energy : {&e.assembly.bonds.fracture_J, &e.assembly.bonds.friction_J})
        std::fill(energy->begin(), energy->end(), 0.0);
    e.platen_work = {};
    e.rate_control_J = 0.0;
    e.weight_start_J = e.weight_work();
}

// Springs rest where the plates have come to.
void hold_springs(Experiment& e) {
    for (DeadLoad& load : e.assembly.dead_loads) {
        load.springs = load.stiffness_Pa_m > 0.0;
        if (load.springs) load.rest_m = dot(e.assembly.nodes.displacement[load.plate_node], load.outward);
    }
}

// From all dead loads back to a share of them that damages nothing. @return the share
double go_below_damage(Experiment& e, const BodyState& unloaded) {
    const BodyState full = capture(e.assembly, e.platen_travel_m);
    const double share = 0.9 * first_damage(e.assembly, unloaded, full);
    go_to(e, superpose(unloaded, full, share));
    e.set_dead_loads(share);
    relax_or_throw(e);
    return share;
}

// Dead loads may take the specimen away from the plates that are to load it, as its weight does under a footing. These go after
// it together, until the first of them touches; that is no loading motion.
void bring_into_touch(Experiment& e) {
    for (const Fixture& fixture : e.assembly.fixtures)
        if (fixture.moves() && fixture.plate < 0) return;
    const double unit_m = 1e-6 * e.length_m, loading_m = e.platen_travel_m;
    const BodyState apart = capture(e.assembly, loading_m);
    move_fixtures(e, unit_m);
    double way_m = std::numeric_limits<double>::infinity();
    for (const Contact& contact : e.assembly.contacts) {
        if (!contact.plate || contact.dropped) continue;
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const auto i = static_cast<std::size_t>(e.assembly.points[p].state);
            const double gap_m = apart.bonds.un_m[i], closed_m = gap_m - e.assembly.bonds.un_m[i];
            if (closed_m > 1e-3 * unit_m) way_m = std::min(way_m, std::max(0.0, gap_m) * unit_m / closed_m);
        }
    }
    go_to(e, apart);
    if (!(way_m > 0.0) || !std::isfinite(way_m)) return;
    move_fixtures(e, way_m);
    e.platen_travel_m = loading_m;
}

// Dead loads on a body of unlimited strength, while the fixtures rest; where they would damage it, a share of them.
// @return whether it bears all of them
bool press_elastically(Experiment& e) {
    if (!e.has_dead_loads()) return true;
    const BodyState unloaded = capture(e.assembly, e.platen_travel_m);
    e.set_dead_loads(1.0);
    relax_or_throw(e);
    const bool elastic = consolidated_is_elastic(e, unloaded);
    if (!elastic) go_below_damage(e, unloaded);
    hold_springs(e);
    bring_into_touch(e);
    return elastic;
}

void rest_under_dead_loads(Experiment& e) {
    hold_springs(e);
    bring_into_touch(e);
    note_consolidated(e);
}

// From the unloaded body, with the real law.
void press_by_ramp(Experiment& e) {
    for (DeadLoad& load : e.assembly.dead_loads) load.springs = false;
    e.set_dead_loads(0.0);
    evaluate_forces(e.assembly, e.team, Strength::real);
    forget_relaxation_work(e);
    if (!e.has_dead_loads()) return;
    consolidate_by_ramp(e);
    rest_under_dead_loads(e);
}

// A first motion along the mode: rates are shares of the motion so far. @param elastic_m  motion at the first damage of the
// elastic body
void set_out(Experiment& e, double elastic_m) {
    constexpr double kShare = 0.01;
    const double travel_m = kShare * elastic_m;
    Nodes& nodes = e.assembly.nodes;
    move_by(e, travel_m, [&] {
        for (int n = 0; n < nodes.count(); ++n) nodes.velocity[n] = travel_m * nodes.loading_mode[n];
    });
}

// Of a confined specimen that its consolidation has damaged: B from an affine guess.
void begin_damaged(Experiment& e) {
    note_consolidated(e);
    const double travel = e.platen_travel_m;
    add_affine(e, 1e-9 * e.length_m);
    const BodyState moved = capture(e.assembly, e.platen_travel_m);
    add_affine(e, travel - e.platen_travel_m);
    set_loading_mode(e, capture(e.assembly, travel), moved);
}

void prepare_adaptive(Experiment& e) {
    if (!e.method.start.stays_in_touch) {
        const BodyState unloaded = capture(e.assembly, 0.0);
        const bool elastic = press_elastically(e);
        forget_relaxation_work(e);
        if (e.has_dead_loads() && elastic) note_consolidated(e);
        elastic_contacts(e);
        if (!elastic) {  // the mode is that of the whole body; the loading begins where the dead loads have left it
            e.ramp.travel_m = e.platen_travel_m;
            go_to(e, unloaded);
            press_by_ramp(e);
            return set_out(e, e.ramp.travel_m);
        }
    } else {
        const BodyState unloaded = capture(e.assembly, 0.0);
        bool elastic = true;
        double consolidated = 1.0;  // share of the dead loads that the elastic body bears
        if (e.confined()) {
            consolidate_elastically(e);
            elastic = consolidated_is_elastic(e, unloaded);
            if (!elastic) consolidated = go_below_damage(e, unloaded);  // then ramp with the real law
        }
        forget_relaxation_work(e);
        if (elastic) {
            note_consolidated(e);
            if (has_cracks(e.assembly) && !e.confined())
                elastic_contacts(e);
            else
                elastic_loading(e, capture(e.assembly, e.platen_travel_m));
        } else {
            const StoredEnergy before = stored_energy(e.assembly, 0.0);
            e.elastic_start_J = before.grains_J + before.contacts_J;
            consolidate_by_ramp(e, consolidated);
            return begin_damaged(e);
        }
    }
    forget_relaxation_work(e);
    e.computed_start = true;
    const StoredEnergy start = stored_energy(e.assembly, 0.0);
    e.elastic_start_J = start.grains_J + start.contacts_J;
}

// From here on the mode only says what is imposed: local damping acts on the total velocity.
void forget_mode(Experiment& e) {
    Nodes& nodes = e.assembly.nodes;
    std::fill(nodes.loading_mode.begin(), nodes.loading_mode.end(), Vec2{});
    e.impose_motion();
}

double fixed_speed(const Experiment& e) { return e.setup.numerics.speed_m.value_or(kPaperSpeed); }

// At the velocities of the mode.
void set_going(Experiment& e) {
    e.change_speed(fixed_speed(e));
    forget_mode(e);
}

// A specimen that is not strained evenly begins with the velocities of its elastic answer: pushed at one place only, it would
// swing.
void begin_in_mode(Experiment& e) {
    const BodyState unloaded = capture(e.assembly, 0.0);
    press_elastically(e);
    elastic_contacts(e);
    go_to(e, unloaded);
    press_by_ramp(e);
    set_going(e);
}

// Rows of nodes begin with an affine velocity field.
void begin_affinely(Experiment& e) {
    note_consolidated(e);
    if (!e.method.start.stays_in_touch) {
        e.change_speed(fixed_speed(e));
        return;
    }
    const double travel = e.platen_travel_m, unit = 1e-6 * e.length_m;
    const BodyState before = capture(e.assembly, travel);
    const Array<Vec2> velocity = e.assembly.nodes.velocity;
    add_affine(e, unit);
    const BodyState moved = capture(e.assembly, e.platen_travel_m);
    go_to(e, before);
    e.assembly.nodes.velocity = velocity;
    set_loading_mode(e, before, moved);
    set_going(e);
}

// The paper's own way, and that of real masses: no computed start.
void prepare_plainly(Experiment& e) {
    if (!e.method.start.strained_evenly) return begin_in_mode(e);
    if (e.confined()) consolidate_by_ramp(e);
    begin_affinely(e);
}

// What follows when the dead loads have been brought up, as above.
void begin_behind_ramp(Experiment& e) {
    const bool adaptive = e.setup.numerics.kind == NumericsKind::adaptive;
    if (adaptive && e.method.start.stays_in_touch) return begin_damaged(e);
    if (!adaptive && e.method.start.strained_evenly) return begin_affinely(e);
    rest_under_dead_loads(e);
    if (adaptive)
        set_out(e, e.ramp.travel_m);
    else
        set_going(e);
}

}  // namespace

void prepare(Experiment& e) {
    if (e.keeping != nullptr && e.keeping->goes_on(TestPart::preparation)) {
        e.keeping->go_on([&](StateReader& reader) { reader.read(e.state()); });
        bring_up_dead_loads(e);
        return begin_behind_ramp(e);
    }
    if (e.setup.numerics.kind == NumericsKind::adaptive) {
        prepare_adaptive(e);
    } else {
        prepare_plainly(e);
    }
}

}  // namespace feldspar
