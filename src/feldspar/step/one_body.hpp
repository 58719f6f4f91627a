// The body stage of one body in readable form. `Model` is an Assembly, or what has its members: a copy on a device (gpu/).
#pragma once

#include "feldspar/laws/damping.hpp"
#include "feldspar/model/attachment.hpp"

namespace feldspar {

/// All slots of a rigid body act on its centre and its turn; a plate has no turn, and nothing in its second slot.
template <class Model>
FELDSPAR_HD void gather_at_centre(Model& assembly, const Body& body) {
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

FELDSPAR_HD inline double pressed_length(const PressureEdge& edge, Vec2 from, Vec2 to) {
    return edge.plate_length_m > 0.0 ? edge.plate_length_m : norm(to - from);
}

/// The forces of the pressures on a body that is pressed, with the first half of their work.
/// A pressure keeps the direction of the undeformed face and acts over its current length. Its work is counted with the
/// mean of the velocities before and after (docs/theory/loading.md), the later one by finish_pressure_work_of().
template <class Model>
FELDSPAR_HD void add_pressure_of(Model& assembly, const Body& body, BodyWork& work, double dt) {
    for (int e = body.pressure_begin; e < body.pressure_end; ++e) {
        const PressureEdge& edge = assembly.pressure_edges[e];
        const double length = pressed_length(edge, assembly.nodes.position(edge.node_a), assembly.nodes.position(edge.node_b));
        const Vec2 half =
            (-0.5 * assembly.pressure_Pa(assembly.dead_loads[edge.load]) * length * assembly.thickness_m) * edge.outward;
        assembly.nodes.force[edge.node_a] += half;
        assembly.nodes.force[edge.node_b] += half;
        work.pressure += 0.5 * dt * dot(half, assembly.nodes.velocity[edge.node_a] + assembly.nodes.velocity[edge.node_b]);
    }
}

/// The second half of the pressures' work: the same forces with the new velocities.
template <class Model>
FELDSPAR_HD void finish_pressure_work_of(Model& assembly, const Body& body, BodyWork& work, double dt) {
    for (int e = body.pressure_begin; e < body.pressure_end; ++e) {
        const PressureEdge& edge = assembly.pressure_edges[e];
        const Vec2 va = assembly.nodes.velocity[edge.node_a], vb = assembly.nodes.velocity[edge.node_b];
        const Vec2 before_a = assembly.nodes.position(edge.node_a) - dt * va,
                   before_b = assembly.nodes.position(edge.node_b) - dt * vb;
        const double pressure_Pa = assembly.pressure_Pa(assembly.dead_loads[edge.load], dt * va);
        const Vec2 half = (-0.5 * pressure_Pa * pressed_length(edge, before_a, before_b) * assembly.thickness_m) * edge.outward;
        work.pressure += 0.5 * dt * dot(half, va + vb);
    }
}

struct DampedMotion {
    double velocity;
    double damping_work;
};

/// m dV/dt = F - alpha |F| sign(V - v B) where that takes energy, one component; the work is taken with the mean velocity.
FELDSPAR_HD inline DampedMotion damp_locally_one(double V, double F, double inverse_mass, double loading, double alpha,
                                                 double dt) {
    const double drag = inverse_mass == 0.0 ? 0.0 : local_drag(V, loading, F, alpha);
    const double next = V + dt * inverse_mass * (F - drag);
    return {next, 0.5 * dt * drag * (V + next)};
}

/// V <- (V (1 - c dt/2) + dt F/m) / (1 + c dt/2), one component.
FELDSPAR_HD inline DampedMotion damp_viscously_one(double V, double F, double inverse_mass, double mass, double c, double dt) {
    const double next = inverse_mass == 0.0 ? V : (V * (1.0 - 0.5 * c * dt) + dt * inverse_mass * F) / (1.0 + 0.5 * c * dt);
    const double moving_mass = inverse_mass == 0.0 ? 0.0 : mass;
    return {next, 0.5 * dt * c * moving_mass * 0.5 * (V + next) * (V + next)};
}

/// New velocities and displacements of a body's nodes from their forces. @tparam local  the damping, else viscous
template <bool local, class Model>
FELDSPAR_HD void move_body(Model& assembly, const Body& body, double dt, double alpha, double viscous, double speed,
                           BodyWork& work) {
    auto& nodes = assembly.nodes;
    double dissipated = 0.0;
    for (const int n : body.nodes()) {
        Vec2& V = nodes.velocity[n];
        const Vec2 F = nodes.force[n], inverse_mass = nodes.inverse_mass[n], B = nodes.loading_mode[n];
        if constexpr (local) {
            const DampedMotion x = damp_locally_one(V.x, F.x, inverse_mass.x, speed * B.x, alpha, dt);
            const DampedMotion y = damp_locally_one(V.y, F.y, inverse_mass.y, speed * B.y, alpha, dt);
            V = {x.velocity, y.velocity};
            dissipated += x.damping_work + y.damping_work;
        } else {
            const double m = nodes.mass[n];
            const DampedMotion x = damp_viscously_one(V.x, F.x, inverse_mass.x, m, viscous, dt);
            const DampedMotion y = damp_viscously_one(V.y, F.y, inverse_mass.y, m, viscous, dt);
            V = {x.velocity, y.velocity};
            dissipated += x.damping_work + y.damping_work;
        }
        nodes.displacement[n] += dt * V;
    }
    work.damping += dissipated;
}

}  // namespace feldspar
