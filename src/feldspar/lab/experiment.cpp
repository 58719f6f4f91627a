#include "feldspar/lab/experiment.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/lab/stability.hpp"
#include "feldspar/model/assemble.hpp"

namespace feldspar {
namespace {

double volume(const Assembly& body) {
    return std::accumulate(body.triangles.begin(), body.triangles.end(), 0.0, [](double sum, const Triangle& t) { return sum + t.volume_m3; });
}

double mass(const Assembly& body) { return std::accumulate(body.nodes.mass.begin(), body.nodes.mass.end(), 0.0); }

}  // namespace

Experiment::Experiment(const TestSetup& s, const RunControl& c)
    : setup(s),
      control(c),
      body(assemble(*s.specimen, s.model, s.grain, s.contact)),
      team(c.threads),
      gauge(body, *s.specimen),
      direction(s.test.kind == TestKind::direct_tension ? -1.0 : 1.0) {
    const Box box = bounding_box(s.specimen->mesh.nodes);
    if (brazilian()) {
        if (!s.specimen->outline.is_disc) throw InputError({}, "a Brazilian test needs a disc");
        height_m = 2.0 * s.specimen->outline.radius_m;
        section_m2 = 0.5 * std::numbers::pi * height_m * body.thickness_m;
        attach_plates(body, *s.specimen, s.contact, s.test.plate_stiffness_factor, s.test.plate_mu.value_or(0.4));
    } else {
        height_m = box.upper.y - box.lower.y;
        attach_platen_rows(body, *s.specimen);
        double left = box.upper.x, right = box.lower.x;
        for (const int node : body.platens[0].nodes) {
            left = std::min(left, body.nodes.reference[node].x);
            right = std::max(right, body.nodes.reference[node].x);
        }
        section_m2 = (right - left) * body.thickness_m;
        body.platens[0].mode = {0.0, -direction};
    }
    axial_stiffness = s.grain.E_Pa * section_m2 / height_m;
    for (const int node : body.platens[0].nodes) body.nodes.loading_mode[node] = body.platens[0].mode;
}

void Experiment::run(int count) {
    advance(body, team, settings, step, count, platen_work);
    platen_travel_m += count * settings.dt * settings.speed;
    step += count;
}

void Experiment::change_speed(double speed) {
    const double dv = speed - settings.speed;
    Nodes& nodes = body.nodes;
    for (int n = 0; n < nodes.count(); ++n) {
        const Vec2 B = nodes.loading_mode[n], before = nodes.velocity[n];
        nodes.velocity[n] += dv * B;
        const Vec2 mean = 0.5 * (before + nodes.velocity[n]);
        if (nodes.inverse_mass[n].x != 0.0) rate_control_J += nodes.mass[n] * dv * B.x * mean.x;
        if (nodes.inverse_mass[n].y != 0.0) rate_control_J += nodes.mass[n] * dv * B.y * mean.y;
    }
    settings.speed = speed;
}

void choose_step(Experiment& e) {
    const NumericsSpec& n = e.setup.numerics;
    if (n.kind == NumericsKind::adaptive) {
        e.settings.damping = Damping::deviation;
        e.mass_factor = n.mass_factor.value_or(1.0);
        set_scaled_masses(e.body, MassBound::tensor, e.mass_factor);
    } else if (n.kind == NumericsKind::paper) {
        e.settings.damping = Damping::local;
        e.settings.alpha = n.damping;
        e.mass_factor = n.mass_factor.value_or(1.0 + n.damping);
        set_scaled_masses(e.body, MassBound::row_sum, e.mass_factor);
    } else {
        e.settings.damping = Damping::local;
        e.settings.alpha = n.damping;
        set_real_masses(e.body, e.setup.grain.density_kg_m3);
    }
    e.omega2 = largest_omega2(e.body, e.team);
    e.omega2_bound = omega2_limit(e.settings.damping, e.settings.alpha);
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
                         n.kind == NumericsKind::paper ? fmt::format("leave the key out: 1 + damping = {:.4g} is then used", 1.0 + n.damping)
                                                       : "leave the key out: 1 is then used");
    }
    const double density = mass(e.body) / volume(e.body);
    e.travel_time = e.height_m * std::sqrt(density / e.setup.grain.E_Pa);   // refined by the elastic start
    if (n.kind == NumericsKind::adaptive) e.settings.viscous = (e.brazilian() ? 1.0 : 2.0) * std::numbers::pi / e.travel_time;
}

}  // namespace feldspar
