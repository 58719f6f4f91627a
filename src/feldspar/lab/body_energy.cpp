#include "feldspar/lab/body_energy.hpp"

#include <cmath>

namespace feldspar {

StoredEnergy stored_energy(const Assembly& assembly) {
    StoredEnergy sum;
    for (const Triangle& triangle : assembly.triangles)
        sum.grains_J += triangle.volume_m3 * strain_energy_density(assembly.elasticity, displacement_gradient(assembly.nodes.displacement, triangle));
    for (const Contact& contact : assembly.contacts) {
        const BondLaw& law = assembly.laws[contact.material];
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const ContactPoint& point = assembly.points[p];
            double& stored = contact.material == inside_grains ? sum.grains_J : sum.contacts_J;
            if (!contact.dropped) stored += elastic_energy(law, point.area_m2, point.bond);
            sum.fracture_J += point.bond.fracture_J;
            sum.friction_J += point.bond.friction_J;
        }
    }
    for (const BodyWork& work : assembly.body_work) {
        sum.damping_J += work.damping;
        sum.pressure_J += work.pressure;
    }
    return sum;
}

KineticEnergy kinetic_energy(const Assembly& assembly, double speed) {
    KineticEnergy sum;
    const Nodes& nodes = assembly.nodes;
    for (int n = 0; n < nodes.count(); ++n) {
        const Vec2 V = nodes.velocity[n], w = V - speed * nodes.loading_mode[n];
        const double free_x = nodes.inverse_mass[n].x != 0.0, free_y = nodes.inverse_mass[n].y != 0.0;
        sum.total_J += 0.5 * nodes.mass[n] * (free_x * V.x * V.x + free_y * V.y * V.y);
        sum.deviation_J += 0.5 * nodes.mass[n] * (free_x * w.x * w.x + free_y * w.y * w.y);
    }
    return sum;
}

double unbalanced_force(const Assembly& assembly) {
    double sum = 0.0;
    const Nodes& nodes = assembly.nodes;
    for (int n = 0; n < nodes.count(); ++n) {
        if (nodes.inverse_mass[n].x != 0.0) sum += std::abs(nodes.force[n].x);
        if (nodes.inverse_mass[n].y != 0.0) sum += std::abs(nodes.force[n].y);
    }
    return sum;
}

double mean_contact_force(const Assembly& assembly) {
    double sum = 0.0;
    for (const ContactPoint& point : assembly.points) sum += std::hypot(point.bond.Fn_N, point.bond.Fs_N);
    return sum / static_cast<double>(assembly.points.size());
}

double fallback_moment_loss(const Assembly& assembly) {
    double lost = 0.0, carried = 0.0;
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        if (!contact.initial_shape || contact.dropped || contact.plate) continue;
        const Vec2 centre = assembly.centre(contact.a.body);
        double moment = 0.0, about_centres = 0.0;
        Vec2 force{};
        for (int i = 0; i < 3; ++i) {
            const Vec2 fa = assembly.slots[2 * c][i], fb = assembly.slots[2 * c + 1][i];
            moment += cross(assembly.nodes.position(contact.a.node[i]) - centre, fa) + cross(assembly.nodes.position(contact.b.node[i]) - centre, fb);
            force += fb;
        }
        about_centres = norm(force) * norm(assembly.centre(contact.b.body) - centre);
        lost += std::abs(moment);
        carried += about_centres;
    }
    return carried > 0.0 ? lost / carried : 0.0;
}

}  // namespace feldspar
