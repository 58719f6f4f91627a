#include "feldspar/lab/body_energy.hpp"

#include <cmath>

namespace feldspar {

StoredEnergy stored_energy(const Assembly& body) {
    StoredEnergy sum;
    for (const Triangle& triangle : body.triangles)
        sum.grains_J += triangle.volume_m3 * strain_energy_density(body.elasticity, displacement_gradient(body.nodes.displacement, triangle));
    for (const Contact& contact : body.contacts) {
        const BondLaw& law = body.laws[contact.material];
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const ContactPoint& point = body.points[p];
            if (!contact.dropped) sum.contacts_J += elastic_energy(law, point.area_m2, point.bond);
            sum.fracture_J += point.bond.fracture_J;
            sum.friction_J += point.bond.friction_J;
        }
    }
    for (const GrainWork& work : body.grain_work) {
        sum.damping_J += work.damping;
        sum.pressure_J += work.pressure;
    }
    return sum;
}

KineticEnergy kinetic_energy(const Assembly& body, double speed) {
    KineticEnergy sum;
    const Nodes& nodes = body.nodes;
    for (int n = 0; n < nodes.count(); ++n) {
        const Vec2 V = nodes.velocity[n], w = V - speed * nodes.loading_mode[n];
        const double free_x = nodes.inverse_mass[n].x != 0.0, free_y = nodes.inverse_mass[n].y != 0.0;
        sum.total_J += 0.5 * nodes.mass[n] * (free_x * V.x * V.x + free_y * V.y * V.y);
        sum.deviation_J += 0.5 * nodes.mass[n] * (free_x * w.x * w.x + free_y * w.y * w.y);
    }
    return sum;
}

double unbalanced_force(const Assembly& body) {
    double sum = 0.0;
    const Nodes& nodes = body.nodes;
    for (int n = 0; n < nodes.count(); ++n) {
        if (nodes.inverse_mass[n].x != 0.0) sum += std::abs(nodes.force[n].x);
        if (nodes.inverse_mass[n].y != 0.0) sum += std::abs(nodes.force[n].y);
    }
    return sum;
}

double mean_contact_force(const Assembly& body) {
    double sum = 0.0;
    for (const ContactPoint& point : body.points) sum += std::hypot(point.bond.Fn_N, point.bond.Fs_N);
    return sum / static_cast<double>(body.points.size());
}

double fallback_moment_loss(const Assembly& body) {
    double lost = 0.0, carried = 0.0;
    for (std::size_t c = 0; c < body.contacts.size(); ++c) {
        const Contact& contact = body.contacts[c];
        if (!contact.initial_shape || contact.dropped || contact.b.grain < 0) continue;
        const Vec2 centre = body.centre(contact.a.grain);
        double moment = 0.0, about_centres = 0.0;
        Vec2 force{};
        for (int i = 0; i < 3; ++i) {
            const Vec2 fa = body.slots[2 * c][i], fb = body.slots[2 * c + 1][i];
            moment += cross(body.nodes.position(contact.a.node[i]) - centre, fa) + cross(body.nodes.position(contact.b.node[i]) - centre, fb);
            force += fb;
        }
        about_centres = norm(force) * norm(body.centre(contact.b.grain) - centre);
        lost += std::abs(moment);
        carried += about_centres;
    }
    return carried > 0.0 ? lost / carried : 0.0;
}

}  // namespace feldspar
