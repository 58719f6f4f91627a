#include "feldspar/lab/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/model/masses.hpp"

namespace feldspar {
namespace {

// Of the specimen that moves, with the masses of the motion; turns and plates do not count.
double mass(const Assembly& assembly) {
    double sum = 0.0;
    for (const Body& body : assembly.bodies) {
        if (body.kind == BodyKind::rigid) sum += assembly.nodes.mass[body.centre_node];
        if (body.kind != BodyKind::flexible) continue;
        for (const int n : body.nodes()) sum += assembly.nodes.mass[n];
    }
    return sum;
}

double volume(const Specimen& specimen) {
    double area = 0.0;
    for (const auto& t : specimen.mesh.triangles) {
        const auto& X = specimen.mesh.nodes;
        area += 0.5 * cross(X[t[1]] - X[t[0]], X[t[2]] - X[t[0]]);
    }
    return area * specimen.spec.thickness_m;
}

// What the specimen's elastic constants may be, before they are measured. Rigid bodies with contacts of stiffness Kn per area,
// a diameter apart, have about Kn times it.
ElasticGuess guess(const TestSetup& setup, const Assembly& assembly) {
    if (setup.model.kind == GrainKind::flexible) return {setup.grain.E_Pa, setup.grain.nu};
    return {setup.contact.Kn_Pa_m * mean_body_diameter(assembly), 0.2};
}

MethodInput input_of(const TestSetup& setup) { return {*setup.specimen, setup.model, setup.grain, setup.contact, setup.test}; }

// Of the pressures that are given, and the weight, N.
double total_of_dead_loads(const Assembly& assembly, const Array<Vec2>& weights) {
    double sum = 0.0;
    for (const PressureEdge& edge : assembly.pressure_edges) {
        const Array<Vec2>& X = assembly.nodes.reference;
        const double length = edge.plate_length_m > 0.0 ? edge.plate_length_m : norm(X[edge.node_b] - X[edge.node_a]);
        sum += assembly.dead_loads[edge.load].given_Pa * length * assembly.thickness_m;
    }
    Vec2 weight;
    for (const Vec2 w : weights) weight += w;
    return sum + norm(weight);
}

// A method may have a gauge on some specimens only: CMOD on beams with a notch.
void require_gauge(const Gauges& gauges, const std::string& name, const char* key) {
    if (gauges.find(name) >= 0) return;
    std::string known;
    for (const GaugeSpec& gauge : gauges.specs()) known += (known.empty() ? "" : ", ") + gauge.name;
    throw InputError({.key = key}, fmt::format("the test of this specimen has no gauge called \"{}\"", name),
                     known.empty() ? "none" : known,
                     name == "CMOD" ? "CMOD is measured on a beam with a notch in the middle of its lower side" : "");
}

}  // namespace

void require_stage(const Experiment& e, const StageSpec& stage) {
    if (e.setup.numerics.kind != NumericsKind::adaptive)
        throw InputError({.key = "test.stages"}, "stages turn the loading motion, which only adaptive numerics do",
                         "[numerics] kind = \"adaptive\", or a test without stages");
    if (stage.end == StageEnd::gauge) require_gauge(e.gauges, stage.gauge, "test.stages");
    if (stage.kind == StageKind::confine && e.assembly.dead_loads.empty())
        throw InputError({.key = "test.stages"}, "a stage changes the pressure on the specimen, and nothing presses on it",
                         "stages without \"confine\", or a test with a pressure");
}

double mean_body_diameter(const Assembly& assembly) {
    double sum = 0.0;
    int count = 0;
    for (const Body& body : assembly.bodies) {
        if (body.kind == BodyKind::plate) continue;
        sum += 2.0 * body.radius_m;
        ++count;
    }
    return sum / count;
}

Experiment::Experiment(const TestSetup& s, const RunControl& c)
    : ExperimentState{.assembly = assemble(*s.specimen, s.model, s.grain, s.contact, s.rock)},
      setup(s),
      method(method_of(s.test)),
      control(c),
      team(c.threads),
      gauge(assembly, *s.specimen),
      direction(method.loading.sign),
      stages(stages_of(s.test)) {
    elastic_guess = guess(s, assembly);
    const MethodInput input = input_of(s);
    attach(assembly, *s.specimen, method.build.fixtures(input));
    length_m = method.build.length_m(input);
    section_m2 = method.build.section_m2(input);
    if (method.build.gauges != nullptr) gauges = Gauges(assembly, *s.specimen, method.build.gauges(input));
    if (s.test.control == LoadControl::gauge) require_gauge(gauges, s.test.control_gauge, "test.control");
    if (s.test.stop_gauge) require_gauge(gauges, s.test.stop_gauge->gauge, "test.until");
    for (const StageGroup& group : stages)
        for (const StageSpec& of_group : group.stages) require_stage(*this, of_group);
    stage = stages.empty() ? 0 : 1;
    axial_stiffness = elastic_guess.E_Pa * section_m2 / length_m;
    if (s.test.custom.gravity_m_s2 != Vec2{}) full_weight = weights(assembly, s.test.custom.gravity_m_s2);
    if (!confined()) dead_load_N = total_of_dead_loads(assembly, full_weight);
    impose_motion();
}

void Experiment::impose_motion() {
    for (const Fixture& fixture : assembly.fixtures)
        for (const int node : fixture.nodes) {
            Vec2& B = assembly.nodes.loading_mode[node];
            if (fixture.imposed.x != 0.0) B.x = fixture.motion.x;
            if (fixture.imposed.y != 0.0) B.y = fixture.motion.y;
        }
}

bool Experiment::has_dead_loads() const {
    return !full_weight.empty() || std::any_of(assembly.dead_loads.begin(), assembly.dead_loads.end(), [](const DeadLoad& load) {
        return load.given_Pa != 0.0 || load.stiffness_Pa_m > 0.0;
    });
}

void Experiment::set_dead_loads(double share) {
    for (DeadLoad& load : assembly.dead_loads) load.pressure_Pa = share * load.given_Pa;
    assembly.weight = full_weight;
    for (Vec2& weight : assembly.weight) weight = share * weight;
}

double Experiment::weight_work(double since) const {
    double work = 0.0;
    for (std::size_t n = 0; n < assembly.weight.size(); ++n)
        work += dot(assembly.weight[n], assembly.nodes.displacement[n] - since * assembly.nodes.velocity[n]);
    return work;
}

void Experiment::run(int count) {
    if (control.more_threads != nullptr) team.grow(control.more_threads->load(std::memory_order_relaxed));
    advance(assembly, team, settings, step, count, platen_work);
    platen_travel_m += count * settings.dt * settings.speed;
    step += count;
    stepped = true;
}

// The next contact stage moves the contacts by the new velocities. So that bodies and contacts stay together, the bodies take the
// difference too, as if the step behind had been made at the new speed; the platens' work is taken with the mean of the two
// steps.
void Experiment::change_speed(double speed) {
    stepped = false;
    const double dv = speed - settings.speed;
    Nodes& nodes = assembly.nodes;
    platen_work.loading += 0.5 * settings.dt * dv * loading_reaction(assembly);
    for (int n = 0; n < nodes.count(); ++n) {
        const Vec2 B = nodes.loading_mode[n], before = nodes.velocity[n];
        nodes.velocity[n] += dv * B;
        nodes.displacement[n] += settings.dt * dv * B;
        const Vec2 mean = 0.5 * (before + nodes.velocity[n]);
        if (nodes.inverse_mass[n].x != 0.0) rate_control_J += nodes.mass[n] * dv * B.x * mean.x;
        if (nodes.inverse_mass[n].y != 0.0) rate_control_J += nodes.mass[n] * dv * B.y * mean.y;
    }
    platen_travel_m += settings.dt * dv;
    settings.speed = speed;
}

// As change_speed() for the components that the fixture imposes: what its nodes and their contacts do is then of the step behind,
// too.
void Experiment::change_motion(std::size_t fixture, Vec2 motion) {
    Fixture& changed = assembly.fixtures[fixture];
    const Vec2 more = motion - changed.motion, dv = settings.speed * Vec2{changed.imposed.x * more.x, changed.imposed.y * more.y};
    stepped = false;
    platen_work.loading -= 0.5 * settings.dt * dot(reaction(assembly, changed), dv);
    Nodes& nodes = assembly.nodes;
    for (const int node : changed.nodes) {
        nodes.velocity[node] += dv;
        nodes.displacement[node] += settings.dt * dv;
    }
    changed.motion = motion;
    impose_motion();
}

namespace {

// The bound behind the masses is rigorous, but a body of a few grains may attain it, and there its fastest motion neither grows
// nor decays: a hundredth of margin, unless the user has chosen the factor.
void keep_margin(Experiment& e, MassBound bound) {
    constexpr double kMargin = 0.99;
    if (e.setup.numerics.mass_factor || e.omega2 <= kMargin * e.omega2_bound) return;
    e.mass_factor *= e.omega2 / (kMargin * e.omega2_bound);
    set_scaled_masses(e.assembly, bound, e.mass_factor);
    e.omega2 = largest_omega2(e.assembly, e.team);
}

}  // namespace

void choose_step(Experiment& e) {
    const NumericsSpec& n = e.setup.numerics;
    const MassBound bound = n.kind == NumericsKind::adaptive ? MassBound::tensor : MassBound::row_sum;
    e.settings.damping = Damping::local;
    e.settings.alpha = n.damping;
    if (n.kind == NumericsKind::dynamic) {
        set_real_masses(e.assembly);
    } else {
        e.mass_factor = n.mass_factor.value_or(1.0 + n.damping);
        set_scaled_masses(e.assembly, bound, e.mass_factor);
    }
    e.omega2 = largest_omega2(e.assembly, e.team);
    e.omega2_bound = omega2_limit(e.settings.damping, e.settings.alpha);
    if (n.kind != NumericsKind::dynamic) keep_margin(e, bound);
    if (n.kind == NumericsKind::dynamic) {
        const double stable = std::sqrt(e.omega2_bound / e.omega2);
        e.settings.dt = n.time_step_s.value_or(0.8 * stable);
        if (e.settings.dt > stable)
            throw InputError({.key = "numerics.time_step"},
                             fmt::format("a time step of {:.4g} s is unstable for this body", e.settings.dt),
                             fmt::format("at most {:.4g} s (largest frequency {:.4g} 1/s, local damping {})", stable,
                                         std::sqrt(e.omega2), n.damping),
                             "leave the key out: 0.8 of the stable step is then used");
        e.omega2 *= e.settings.dt * e.settings.dt;
    } else if (e.omega2 > e.omega2_bound) {
        throw InputError({.key = "numerics.mass_factor"},
                         fmt::format("a mass factor of {:.4g} is unstable for this body: largest omega^2 {:.4g}, limit {:.4g}",
                                     e.mass_factor, e.omega2, e.omega2_bound),
                         fmt::format("at least {:.4g}", e.mass_factor * e.omega2 / e.omega2_bound),
                         fmt::format("leave the key out: 1 + damping = {:.4g} is then used", 1.0 + n.damping));
    }
    const double density = mass(e.assembly) / volume(*e.setup.specimen);
    double distance = e.length_m;
    if (e.method.start.time_of_mode) {  // its length may be any
        const Box box = bounding_box(e.setup.specimen->mesh.nodes);
        distance = std::max(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
    }
    e.travel_time = distance * std::sqrt(density / e.elastic_guess.E_Pa);  // refined by the elastic start
}

}  // namespace feldspar
