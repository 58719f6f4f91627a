#include <cmath>

#include "feldspar/laws/damping.hpp"
#include "feldspar/model/attachment.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

void weigh(Assembly& assembly, const Body& body) {
    for (const int n : body.nodes()) assembly.nodes.force[n] = assembly.weight.empty() ? Vec2{} : assembly.weight[n];
}

namespace {

void gather_contacts(Assembly& assembly, const Body& body) {
    weigh(assembly, body);
    const Vec2 centre = assembly.nodes.position(body.centre_node);
    for (int i = body.slot_begin; i < body.slot_end; ++i) {
        const int slot = assembly.slots_of_bodies[i];
        const Contact& contact = assembly.contacts[slot / 2];
        const SideNodes& node = slot % 2 == 0 ? contact.a.node : contact.b.node;
        const std::array<Vec2, 3> f = forces_on_corners(corners(assembly.nodes, node), centre, assembly.slots[slot]);
        for (int k = 0; k < 3; ++k) assembly.nodes.force[node[k]] += f[k];
    }
}

// All slots of a rigid body act on its centre and its turn; a plate has no turn, and nothing in its second slot.
void gather_at_centre(Assembly& assembly, const Body& body) {
    Vec2 force;
    double moment = 0.0;
    for (int i = body.slot_begin; i < body.slot_end; ++i) {
        const SlotForces& slot = assembly.slots[assembly.slots_of_bodies[i]];
        force += slot.force;
        moment += turning_moment(slot);
    }
    if (!assembly.weight.empty()) force += assembly.weight[body.centre_node];
    assembly.nodes.force[body.centre_node] = force;
    if (body.kind == BodyKind::rigid) assembly.nodes.force[body.centre_node + 1] = {moment / body.radius_m, 0.0};
}

void add_triangles(Assembly& assembly, const Body& body) {
    const std::span<const Vec2> u = assembly.nodes.displacement;
    const PlaneElasticity& D = assembly.elasticity_of(static_cast<int>(&body - assembly.bodies.data()));
    for (int t = body.triangle_begin; t < body.triangle_end; ++t) {
        const Triangle& triangle = assembly.triangles[t];
        const auto [i, j, k] = triangle.node;
        const Mat2 P = first_piola_stress(D, displacement_gradient(u, triangle));
        const Vec2 fj = -triangle.volume_m3 * (P * triangle.gradient[0]), fk = -triangle.volume_m3 * (P * triangle.gradient[1]);
        assembly.nodes.force[j] += fj;
        assembly.nodes.force[k] += fk;
        assembly.nodes.force[i] -= fj + fk;
    }
}

double pressed_length(const PressureEdge& edge, Vec2 from, Vec2 to) { return edge.plate_length_m > 0.0 ? edge.plate_length_m : norm(to - from); }

}  // namespace

// A pressure keeps the direction of the undeformed face and acts over its current length. Its work is counted with the
// mean of the velocities before and after (docs/theory/loading.md), the later one in integrate().
void add_pressure(Assembly& assembly, const Body& body, BodyWork& work, double dt) {
    if (!assembly.is_pressed()) return;
    for (int e = body.pressure_begin; e < body.pressure_end; ++e) {
        const PressureEdge& edge = assembly.pressure_edges[e];
        const double length = pressed_length(edge, assembly.nodes.position(edge.node_a), assembly.nodes.position(edge.node_b));
        const Vec2 half = (-0.5 * assembly.pressure_Pa(assembly.dead_loads[edge.load]) * length * assembly.thickness_m) * edge.outward;
        assembly.nodes.force[edge.node_a] += half;
        assembly.nodes.force[edge.node_b] += half;
        work.pressure += 0.5 * dt * dot(half, assembly.nodes.velocity[edge.node_a] + assembly.nodes.velocity[edge.node_b]);
    }
}

namespace {

struct Motion {
    double velocity;
    double damping_work;
};

// m dV/dt = F - alpha |F| sign(V - v B) where that takes energy, one component; the work is taken with the mean velocity.
Motion damp_locally(double V, double F, double inverse_mass, double loading, double alpha, double dt) {
    const double drag = inverse_mass == 0.0 ? 0.0 : local_drag(V, loading, F, alpha);
    const double next = V + dt * inverse_mass * (F - drag);
    return {next, 0.5 * dt * drag * (V + next)};
}

// V <- (V (1 - c dt/2) + dt F/m) / (1 + c dt/2), one component.
Motion damp_viscously(double V, double F, double inverse_mass, double mass, double c, double dt) {
    const double next = inverse_mass == 0.0 ? V : (V * (1.0 - 0.5 * c * dt) + dt * inverse_mass * F) / (1.0 + 0.5 * c * dt);
    const double moving_mass = inverse_mass == 0.0 ? 0.0 : mass;
    return {next, 0.5 * dt * c * moving_mass * 0.5 * (V + next) * (V + next)};
}

template <Damping damping>
void integrate(Assembly& assembly, const Body& body, const StepSettings& settings, BodyWork& work) {
    Nodes& nodes = assembly.nodes;
    const double dt = settings.dt;
    double dissipated = 0.0;
    for (const int n : body.nodes()) {
        Vec2& V = nodes.velocity[n];
        const Vec2 F = nodes.force[n], inverse_mass = nodes.inverse_mass[n], B = nodes.loading_mode[n];
        if constexpr (damping == Damping::local) {
            const double v = settings.speed;
            const Motion x = damp_locally(V.x, F.x, inverse_mass.x, v * B.x, settings.alpha, dt);
            const Motion y = damp_locally(V.y, F.y, inverse_mass.y, v * B.y, settings.alpha, dt);
            V = {x.velocity, y.velocity};
            dissipated += x.damping_work + y.damping_work;
        } else {
            const double m = nodes.mass[n], c = settings.viscous;
            const Motion x = damp_viscously(V.x, F.x, inverse_mass.x, m, c, dt);
            const Motion y = damp_viscously(V.y, F.y, inverse_mass.y, m, c, dt);
            V = {x.velocity, y.velocity};
            dissipated += x.damping_work + y.damping_work;
        }
        nodes.displacement[n] += dt * V;
    }
    work.damping += dissipated;
}

}  // namespace

// The second half of the pressure's work: the same forces with the new velocities.
void finish_pressure_work(Assembly& assembly, const Body& body, BodyWork& work, double dt) {
    if (!assembly.is_pressed()) return;
    for (int e = body.pressure_begin; e < body.pressure_end; ++e) {
        const PressureEdge& edge = assembly.pressure_edges[e];
        const Vec2 va = assembly.nodes.velocity[edge.node_a], vb = assembly.nodes.velocity[edge.node_b];
        const Vec2 before_a = assembly.nodes.position(edge.node_a) - dt * va, before_b = assembly.nodes.position(edge.node_b) - dt * vb;
        const double pressure_Pa = assembly.pressure_Pa(assembly.dead_loads[edge.load], dt * va);
        const Vec2 half = (-0.5 * pressure_Pa * pressed_length(edge, before_a, before_b) * assembly.thickness_m) * edge.outward;
        work.pressure += 0.5 * dt * dot(half, va + vb);
    }
}

void body_forces(Assembly& assembly, IndexRange bodies, const StepSettings& settings) {
    for (int b = bodies.begin; b < bodies.end; ++b) {
        const Body& body = assembly.bodies[b];
        BodyWork& work = assembly.body_work[b];
        if (body.kind == BodyKind::flexible) {
            gather_contacts(assembly, body);
            add_triangles(assembly, body);
        } else {
            gather_at_centre(assembly, body);
        }
        add_pressure(assembly, body, work, settings.dt);
        if (settings.damping == Damping::local) {
            integrate<Damping::local>(assembly, body, settings, work);
        } else {
            integrate<Damping::viscous>(assembly, body, settings, work);
        }
        finish_pressure_work(assembly, body, work, settings.dt);
    }
}

}  // namespace feldspar
