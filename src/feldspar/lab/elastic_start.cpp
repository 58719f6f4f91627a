#include "feldspar/lab/elastic_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/lab/body_energy.hpp"

namespace feldspar {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Damping as a share of the critical damping of the Rayleigh quotient. The quotient of many modes lies above the slowest mode,
// which decides how long it takes.
constexpr double kOfCritical = 0.6;

// Smallest factor > 0 with value + factor x change = limit; the start is below the limit.
double reaches(double value, double change, double limit) {
    return change > 0.0 ? std::max(0.0, (limit - value) / change) : kNever;
}

// The same for shear with friction on top of the cohesion: ks |us| - mu max(-kn un, 0) = tau, per area.
double shear_with_friction(const BondLaw& law, const BondState& base, double dun, double dus) {
    double first = kNever;
    for (const double sign : {1.0, -1.0}) {
        const double shear = sign * law.Ks_Pa_m * base.us_m, dshear = sign * law.Ks_Pa_m * dus;
        const double open = reaches(shear, dshear, law.tau_Pa);
        if (open < kNever && base.un_m + open * dun >= 0.0) first = std::min(first, open);
        const double pressed = reaches(shear + law.mu * law.Kn_Pa_m * base.un_m, dshear + law.mu * law.Kn_Pa_m * dun, law.tau_Pa);
        if (pressed < kNever && base.un_m + pressed * dun <= 0.0) first = std::min(first, pressed);
    }
    return first;
}

}  // namespace

BodyState capture(const Assembly& assembly, double platen_travel_m) {
    return {platen_travel_m, assembly.nodes.displacement, assembly.bonds};
}

void restore(Assembly& assembly, const BodyState& state) {
    assembly.nodes.displacement = state.displacement_m;
    std::fill(assembly.nodes.velocity.begin(), assembly.nodes.velocity.end(), Vec2{});
    assembly.bonds = state.bonds;
}

BodyState superpose(const BodyState& base, const BodyState& state, double factor) {
    BodyState sum = base;
    const auto mix = [factor](double from, double to) { return from + factor * (to - from); };
    sum.platen_travel_m = mix(base.platen_travel_m, state.platen_travel_m);
    for (std::size_t n = 0; n < sum.displacement_m.size(); ++n)
        sum.displacement_m[n] += factor * (state.displacement_m[n] - base.displacement_m[n]);
    for (Array<double> Bonds::*quantity : {&Bonds::un_m, &Bonds::us_m, &Bonds::Fn_N, &Bonds::Fs_N, &Bonds::slip_m})
        for (std::size_t i = 0; i < (sum.bonds.*quantity).size(); ++i)
            (sum.bonds.*quantity)[i] = mix((base.bonds.*quantity)[i], (state.bonds.*quantity)[i]);
    return sum;
}

double first_damage(const Assembly& assembly, const BodyState& base, const BodyState& state) {
    double first = kNever;
    for (const Contact& contact : assembly.contacts) {
        const BondLaw law = assembly.law_of(contact);
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const auto i = static_cast<std::size_t>(assembly.points[p].state);
            const BondState b = base.bonds.at(i);
            if (b.damage >= 1.0) continue;
            const double dun = state.bonds.un_m[i] - b.un_m, dus = state.bonds.us_m[i] - b.us_m;
            first = std::min(first, reaches(b.un_m, dun, law.normal.x0));
            if (law.shear.brittle || law.shear_beyond_friction) {
                first = std::min(first, shear_with_friction(law, b, dun, dus));
            } else {
                first = std::min({first, reaches(b.us_m, dus, law.shear.x0), reaches(-b.us_m, -dus, law.shear.x0)});
            }
        }
    }
    return first;
}

Relaxation relax(Assembly& assembly, Team& team, Strength strength, double tolerance, long long maximum_steps,
                 const std::function<bool()>& stop, double dt) {
    StepSettings settings;
    settings.dt = dt;
    settings.strength = strength;
    Nodes& nodes = assembly.nodes;
    std::fill(nodes.velocity.begin(), nodes.velocity.end(), Vec2{});
    evaluate_forces(assembly, team, strength);
    Array<Vec2> force_before = nodes.force, velocity_before = nodes.velocity;
    PlatenWork none;
    Relaxation result;
    double largest_contacts = 0.0;
    StepSequence steps(assembly, team);  // in between nodes are only read
    while (result.steps < maximum_steps && !(stop && stop())) {
        force_before = nodes.force;
        velocity_before = nodes.velocity;
        steps.advance(settings, -1, 1, none);
        ++result.steps;

        double stiffness = 0.0, inertia = 0.0, force = 0.0;
        for (int n = 0; n < nodes.count(); ++n) {
            const double fx = nodes.inverse_mass[n].x != 0.0, fy = nodes.inverse_mass[n].y != 0.0;
            const Vec2 v = {fx * velocity_before[n].x, fy * velocity_before[n].y};
            stiffness -= dot(v, nodes.force[n] - force_before[n]);
            inertia += nodes.mass[n] * dot(v, v);
            force += norm({fx * nodes.force[n].x, fy * nodes.force[n].y});
        }
        if (inertia > 0.0 && stiffness > 0.0)
            settings.viscous = std::min(1.9 / dt, kOfCritical * 2.0 * std::sqrt(stiffness / (dt * inertia)));
        if (result.steps % 10 == 0) {
            constexpr double kNothing =
                1e-6;  // of the largest: a body that nothing holds together, behind an open joint, has come to rest without force
            const double contacts = mean_contact_force(assembly);
            largest_contacts = std::max(largest_contacts, contacts);
            if (contacts < kNothing * largest_contacts) {
                result.converged = true;
                break;
            }
            result.residual = contacts > 0.0 ? force / nodes.count() / contacts : kNever;
            if (!std::isfinite(force)) break;
            if (result.residual < tolerance) {
                result.converged = true;
                break;
            }
        }
    }
    std::fill(nodes.velocity.begin(), nodes.velocity.end(), Vec2{});
    for (BodyWork& work : assembly.body_work) work = {};  // relaxation is not part of the test's energy balance
    return result;
}

}  // namespace feldspar
