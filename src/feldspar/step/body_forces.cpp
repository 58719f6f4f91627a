#include "feldspar/step/one_body.hpp"
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

}  // namespace

void add_pressure(Assembly& assembly, const Body& body, BodyWork& work, double dt) {
    if (assembly.is_pressed()) add_pressure_of(assembly, body, work, dt);
}

void finish_pressure_work(Assembly& assembly, const Body& body, BodyWork& work, double dt) {
    if (assembly.is_pressed()) finish_pressure_work_of(assembly, body, work, dt);
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
            move_body<true>(assembly, body, settings.dt, settings.alpha, settings.viscous, settings.speed, work);
        } else {
            move_body<false>(assembly, body, settings.dt, settings.alpha, settings.viscous, settings.speed, work);
        }
        finish_pressure_work(assembly, body, work, settings.dt);
    }
}

}  // namespace feldspar
