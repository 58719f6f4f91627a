#include <cmath>

#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

void gather_contacts(Assembly& body, const Grain& grain) {
    for (int n = grain.node_begin; n < grain.node_end; ++n) body.nodes.force[n] = {};
    for (int i = grain.slot_begin; i < grain.slot_end; ++i) {
        const int slot = body.slots_of_grains[i];
        const Contact& contact = body.contacts[slot / 2];
        const EdgeNodes& node = slot % 2 == 0 ? contact.a.node : contact.b.node;
        for (int k = 0; k < 3; ++k) body.nodes.force[node[k]] += body.slots[slot][k];
    }
}

void add_triangles(Assembly& body, const Grain& grain) {
    const std::vector<Vec2>& u = body.nodes.displacement;
    for (int t = grain.triangle_begin; t < grain.triangle_end; ++t) {
        const Triangle& triangle = body.triangles[t];
        const auto [i, j, k] = triangle.node;
        const Mat2 P = first_piola_stress(body.elasticity, displacement_gradient(u, triangle));
        const Vec2 fj = -triangle.volume_m3 * (P * triangle.gradient[0]), fk = -triangle.volume_m3 * (P * triangle.gradient[1]);
        body.nodes.force[j] += fj;
        body.nodes.force[k] += fk;
        body.nodes.force[i] -= fj + fk;
    }
}

// The pressure keeps the direction of the undeformed face and acts over its current length. Its work is counted with the
// mean of the velocities before and after (docs/theory/loading.md), the later one in integrate().
void add_pressure(Assembly& body, const Grain& grain, GrainWork& work, double dt) {
    if (body.pressure_Pa == 0.0) return;
    for (int e = grain.pressure_begin; e < grain.pressure_end; ++e) {
        const PressureEdge& edge = body.pressure_edges[e];
        const double length = norm(body.nodes.position(edge.node_b) - body.nodes.position(edge.node_a));
        const Vec2 half = (-0.5 * body.pressure_Pa * length * body.thickness_m) * edge.outward;
        body.nodes.force[edge.node_a] += half;
        body.nodes.force[edge.node_b] += half;
        work.pressure += 0.5 * dt * dot(half, body.nodes.velocity[edge.node_a] + body.nodes.velocity[edge.node_b]);
    }
}

struct Motion {
    double velocity;
    double damping_work;
};

// m dV/dt = F - alpha |F| sign(V), one component; the work is taken with the mean velocity.
Motion damp_locally(double V, double F, double inverse_mass, double alpha, double dt) {
    const double drag = inverse_mass == 0.0 || V == 0.0 ? 0.0 : std::copysign(alpha * std::abs(F), V);
    const double next = V + dt * inverse_mass * (F - drag);
    return {next, 0.5 * dt * drag * (V + next)};
}

// w <- (w (1 - c dt/2) + dt F/m) / (1 + c dt/2), V = v B + w.
Motion damp_deviation(double V, double F, double inverse_mass, double mass, double loading, double c, double dt) {
    const double w = V - loading;
    const double next = (w * (1.0 - 0.5 * c * dt) + dt * inverse_mass * F) / (1.0 + 0.5 * c * dt);
    const double moving_mass = inverse_mass == 0.0 ? 0.0 : mass;
    return {loading + next, 0.5 * dt * c * moving_mass * 0.5 * (w + next) * (V + loading + next)};
}

template <Damping damping>
void integrate(Assembly& body, const Grain& grain, const StepSettings& settings, GrainWork& work) {
    Nodes& nodes = body.nodes;
    const double dt = settings.dt;
    double dissipated = 0.0;
    for (int n = grain.node_begin; n < grain.node_end; ++n) {
        Vec2& V = nodes.velocity[n];
        const Vec2 F = nodes.force[n], inverse_mass = nodes.inverse_mass[n], B = nodes.loading_mode[n];
        if constexpr (damping == Damping::local) {
            const Motion x = damp_locally(V.x, F.x, inverse_mass.x, settings.alpha, dt);
            const Motion y = damp_locally(V.y, F.y, inverse_mass.y, settings.alpha, dt);
            V = {x.velocity, y.velocity};
            dissipated += x.damping_work + y.damping_work;
        } else {
            const double m = nodes.mass[n], c = settings.viscous, v = settings.speed;
            const Motion x = damp_deviation(V.x, F.x, inverse_mass.x, m, v * B.x, c, dt);
            const Motion y = damp_deviation(V.y, F.y, inverse_mass.y, m, v * B.y, c, dt);
            V = {x.velocity, y.velocity};
            dissipated += x.damping_work + y.damping_work;
        }
        nodes.displacement[n] += dt * V;
    }
    work.damping += dissipated;
}

// The second half of the pressure's work: the same forces with the new velocities.
void finish_pressure_work(Assembly& body, const Grain& grain, GrainWork& work, double dt) {
    if (body.pressure_Pa == 0.0) return;
    for (int e = grain.pressure_begin; e < grain.pressure_end; ++e) {
        const PressureEdge& edge = body.pressure_edges[e];
        const Vec2 va = body.nodes.velocity[edge.node_a], vb = body.nodes.velocity[edge.node_b];
        const Vec2 before_a = body.nodes.position(edge.node_a) - dt * va, before_b = body.nodes.position(edge.node_b) - dt * vb;
        const Vec2 half = (-0.5 * body.pressure_Pa * norm(before_b - before_a) * body.thickness_m) * edge.outward;
        work.pressure += 0.5 * dt * dot(half, va + vb);
    }
}

}  // namespace

void grain_forces(Assembly& body, IndexRange grains, const StepSettings& settings) {
    for (int g = grains.begin; g < grains.end; ++g) {
        const Grain& grain = body.grains[g];
        GrainWork& work = body.grain_work[g];
        gather_contacts(body, grain);
        add_triangles(body, grain);
        add_pressure(body, grain, work, settings.dt);
        if (settings.damping == Damping::local) {
            integrate<Damping::local>(body, grain, settings, work);
        } else {
            integrate<Damping::deviation>(body, grain, settings, work);
        }
        finish_pressure_work(body, grain, work, settings.dt);
    }
}

}  // namespace feldspar
