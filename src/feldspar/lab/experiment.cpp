#include "feldspar/lab/experiment.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/flattened_disc.hpp"
#include "feldspar/lab/specimen_shape.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/model/platens.hpp"

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

PlateContact plate_contact(const TestSetup& setup) {
    const TestSpec& test = setup.test;
    const TestMethod& method = method_of(test);
    PlateContact contact;
    contact.Kn_Pa_m = test.plate_Kn_Pa_m.value_or(test.plate_stiffness_factor * setup.contact.Kn_Pa_m);
    contact.eta = setup.contact.eta;
    contact.mu = test.plate_mu.value_or(method.specimen.plate_mu);
    if (method.specimen.own_disc && test.plates == PlateShape::curved) contact.jaw_radius_m = test.jaw_radius * setup.specimen->outline.radius_m;
    contact.glued = method.specimen.glued;
    return contact;
}

void attach_platens(Assembly& assembly, const TestSetup& setup) {
    const Specimen& specimen = *setup.specimen;
    const PlateContact contact = plate_contact(setup);
    if (method_of(setup.test).specimen.own_disc) {
        attach_brazilian_plates(assembly, specimen, contact);
    } else if (setup.model.kind == GrainKind::flexible) {
        attach_platen_rows(assembly, specimen);
    } else {
        attach_end_plates(assembly, specimen, contact);
        if (is_confined(setup.test))
            attach_membranes(assembly, specimen, {setup.contact.Kn_Pa_m, setup.contact.eta, 0.0, false}, setup.test.membrane_plates);
    }
}

}  // namespace

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
    : setup(s),
      method(method_of(s.test)),
      control(c),
      assembly(assemble(*s.specimen, s.model, s.grain, s.contact)),
      team(c.threads),
      gauge(assembly, *s.specimen),
      direction(method.loading.sign),
      elastic_guess(guess(s, assembly)) {
    const Box box = bounding_box(s.specimen->mesh.nodes);
    if (method.specimen.own_disc && !s.specimen->outline.is_disc) throw InputError({}, "a Brazilian test needs a disc");
    attach_platens(assembly, s);
    if (method.specimen.own_disc) {
        const Outline& disc = s.specimen->outline;
        height_m = 2.0 * (disc.flattened() ? disc.flat_height_m : disc.radius_m);
        section_m2 = 0.5 * std::numbers::pi * 2.0 * disc.radius_m * assembly.thickness_m;
        if (disc.flattened()) section_m2 /= flat_coefficient(*s.specimen, s.model, s.grain, s.contact, s.test);
    } else {
        height_m = box.upper.y - box.lower.y;
        section_m2 = section_width_m(s.specimen->outline, loaded_width_m(assembly, *s.specimen)) * assembly.thickness_m;
        assembly.platens[0].mode = {0.0, -direction};
    }
    axial_stiffness = elastic_guess.E_Pa * section_m2 / height_m;
    for (const int node : assembly.platens[0].nodes) assembly.nodes.loading_mode[node] = assembly.platens[0].mode;
}

void Experiment::run(int count) {
    if (control.more_threads != nullptr) team.grow(control.more_threads->load(std::memory_order_relaxed));
    advance(assembly, team, settings, step, count, platen_work);
    platen_travel_m += count * settings.dt * settings.speed;
    step += count;
    stepped = true;
}

// The next contact stage moves the contacts by the new velocities. So that bodies and contacts stay together, the bodies take the
// difference too, as if the step behind had been made at the new speed; the platens' work is taken with the mean of the two steps.
void Experiment::change_speed(double speed) {
    stepped = false;
    const double dv = speed - settings.speed;
    Nodes& nodes = assembly.nodes;
    platen_work.loading -= 0.5 * settings.dt * dv * platen_reactions(assembly).loading * assembly.platens[0].mode.y;
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
        set_real_masses(e.assembly, e.setup.grain.density_kg_m3);
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
                             fmt::format("at most {:.4g} s (largest frequency {:.4g} 1/s, local damping {})", stable, std::sqrt(e.omega2), n.damping),
                             "leave the key out: 0.8 of the stable step is then used");
        e.omega2 *= e.settings.dt * e.settings.dt;
    } else if (e.omega2 > e.omega2_bound) {
        throw InputError({.key = "numerics.mass_factor"},
                         fmt::format("a mass factor of {:.4g} is unstable for this body: largest omega^2 {:.4g}, limit {:.4g}", e.mass_factor,
                                     e.omega2, e.omega2_bound),
                         fmt::format("at least {:.4g}", e.mass_factor * e.omega2 / e.omega2_bound),
                         fmt::format("leave the key out: 1 + damping = {:.4g} is then used", 1.0 + n.damping));
    }
    const double density = mass(e.assembly) / volume(*e.setup.specimen);
    e.travel_time = e.height_m * std::sqrt(density / e.elastic_guess.E_Pa);   // refined by the elastic start
}

}  // namespace feldspar
