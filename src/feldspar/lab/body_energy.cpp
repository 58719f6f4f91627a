#include "feldspar/lab/body_energy.hpp"

#include <cmath>

#include "feldspar/step/advance_packs.hpp"

namespace feldspar {

StoredEnergy stored_energy(const Assembly& assembly, double since) {
    StoredEnergy sum;
    const PackEnergies packs = best_kernels().energies(KernelArrays::to_read(assembly), since);
    sum.grains_J = packs.grains + packs.contacts[inside_grains];
    for (int role = 0; role < contact_roles; ++role)
        if (role != inside_grains) sum.contacts_J += packs.contacts[role];
    sum.fracture_J = packs.fracture;
    sum.friction_J = packs.friction;
    const Nodes& nodes = assembly.nodes;
    Array<Vec2> u;  // of grains in no pack, if there are any
    for (const int b : assembly.packs.loose_bodies) {
        const Body& grain = assembly.bodies[b];
        if (u.empty() && grain.triangle_begin < grain.triangle_end) u = nodes.displacement;
        for (int t = grain.triangle_begin; t < grain.triangle_end; ++t) {
            const Triangle& triangle = assembly.triangles[t];
            for (const int n : triangle.node) u[n] = nodes.displacement[n] - since * nodes.velocity[n];
            sum.grains_J +=
                triangle.volume_m3 * strain_energy_density(assembly.elasticity_of(b), displacement_gradient(u, triangle));
        }
    }
    for (const BodyWork& work : assembly.body_work) {
        sum.damping_J += work.damping;
        sum.pressure_J += work.pressure;
    }
    return sum;
}

namespace {

double pressure_power(const Assembly& assembly) {
    double power = 0.0;
    for (const PressureEdge& edge : assembly.pressure_edges) {
        const Nodes& nodes = assembly.nodes;
        const double length =
            edge.plate_length_m > 0.0 ? edge.plate_length_m : norm(nodes.position(edge.node_b) - nodes.position(edge.node_a));
        power -= 0.5 * assembly.pressure_Pa(assembly.dead_loads[edge.load]) * length * assembly.thickness_m *
                 dot(edge.outward, nodes.velocity[edge.node_a] + nodes.velocity[edge.node_b]);
    }
    return power;
}

}  // namespace

Motion motion(const Assembly& assembly, const StepSettings& settings) {
    const NodeSums sums = best_kernels().node_sums(KernelArrays::to_read(assembly), kernel_step(settings));
    Motion motion;
    motion.kinetic_J = sums.kinetic;
    motion.deviation_J = sums.deviation;
    motion.ahead_damping_J = sums.ahead_damping;
    const double platen_power = loading_reaction(assembly) * settings.speed;
    motion.ahead_external_J = 0.5 * settings.dt * (platen_power + pressure_power(assembly));
    return motion;
}

std::vector<double> unbalanced_forces(const Assembly& assembly) {
    std::vector<double> of_bodies(assembly.bodies.size(), 0.0);
    best_kernels().unbalanced(KernelArrays::to_read(assembly), of_bodies.data());
    const Nodes& nodes = assembly.nodes;
    for (std::size_t b = 0; b < of_bodies.size(); ++b) {
        if (assembly.packs.pack_of_body[b] >= 0) continue;
        for (const int n : assembly.bodies[b].nodes()) {
            if (nodes.inverse_mass[n].x != 0.0) of_bodies[b] += std::abs(nodes.force[n].x);
            if (nodes.inverse_mass[n].y != 0.0) of_bodies[b] += std::abs(nodes.force[n].y);
        }
    }
    return of_bodies;
}

double unbalanced_force(const Assembly& assembly) {
    double sum = 0.0;
    for (const double force : unbalanced_forces(assembly)) sum += force;
    return sum;
}

double mean_contact_force(const Assembly& assembly) {
    double sum = 0.0;
    for (std::size_t i = 0; i < assembly.bonds.Fn_N.size(); ++i) sum += norm({assembly.bonds.Fn_N[i], assembly.bonds.Fs_N[i]});
    return sum / static_cast<double>(assembly.points.size());
}

double fallback_moment_loss(const Assembly& assembly) {
    double lost = 0.0, carried = 0.0;
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        if (!contact.initial_shape || contact.dropped || contact.plate) continue;
        const Vec2 centre = assembly.centre(contact.a.body);
        const Vec2 line = assembly.centre(contact.b.body) - centre;
        const SlotForces &a = assembly.slots[2 * c], &b = assembly.slots[2 * c + 1];
        lost += std::abs(turning_moment(a) + turning_moment(b) + cross(line, b.force));
        carried += norm(b.force) * norm(line);
    }
    return carried > 0.0 ? lost / carried : 0.0;
}

}  // namespace feldspar
