#include <algorithm>

#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

// A side of a contact as the point loop sees it: velocity at a point, and where to put a force.
class GrainAttachment {
public:
    GrainAttachment(const Nodes& nodes, const EdgeNodes& t)
        : corner_(corners(nodes, t)), velocity_{nodes.velocity[t[0]], nodes.velocity[t[1]], nodes.velocity[t[2]]} {}

    std::array<double, 3> shape(Vec2 x) const { return shape_functions(corner_, x); }
    Vec2 velocity(const std::array<double, 3>& N) const { return N[0] * velocity_[0] + N[1] * velocity_[1] + N[2] * velocity_[2]; }

private:
    std::array<Vec2, 3> corner_;
    std::array<Vec2, 3> velocity_;
};

void add(SlotForces& slot, const std::array<double, 3>& N, Vec2 force) {
    for (int i = 0; i < 3; ++i) slot[i] += N[i] * force;
}

BondEvent apply_law(const BondLaw& law, double area_m2, double dun, double dus, Strength strength, BondState& bond) {
    if (strength == Strength::unlimited && update_elastic(law, area_m2, dun, dus, bond)) return BondEvent::none;
    return update_bond(law, area_m2, dun, dus, bond);
}

void forces_of_contact(Assembly& body, int index, const StepSettings& settings, long long step) {
    const Contact& contact = body.contacts[index];
    SlotForces& slot_a = body.slots[2 * index];
    SlotForces& slot_b = body.slots[2 * index + 1];
    slot_a = slot_b = SlotForces{};
    if (contact.dropped) return;

    const ContactFrame frame = contact_frame(body, contact);
    const Vec2 s = rot90(frame.n);
    const bool grain_b = contact.b.grain >= 0;
    const GrainAttachment a(body.nodes, contact.a.node);
    const GrainAttachment b(body.nodes, grain_b ? contact.b.node : contact.a.node);
    const Vec2 platen_velocity = grain_b ? Vec2{} : settings.speed * body.platens[contact.b.platen].mode;

    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        ContactPoint& point = body.points[p];
        const Vec2 x = frame.reference_point + point.along_m * frame.edge_tangent;
        const std::array<double, 3> Na = contact.initial_shape ? body.initial_shapes[p].a : a.shape(x);
        const std::array<double, 3> Nb = contact.initial_shape ? body.initial_shapes[p].b : b.shape(x);
        const Vec2 relative = (grain_b ? b.velocity(Nb) : platen_velocity) - a.velocity(Na);

        const BondEvent event = apply_law(body.laws[contact.material], point.area_m2, settings.dt * dot(relative, frame.n),
                                          settings.dt * dot(relative, s), settings.strength, point.bond);
        if (event != BondEvent::none) {
            point.broken_step = step;
            point.broke_in_tension = event == BondEvent::broke_in_tension;
            point.lost_compression = event == BondEvent::broke_in_shear_losing_compression;
        }
        const Vec2 on_b = point.bond.Fn_N * frame.n + point.bond.Fs_N * s;   // compression pushes B along n
        add(slot_a, Na, -on_b);
        if (grain_b) {
            add(slot_b, Nb, on_b);
        } else {
            slot_b[0] += on_b;
        }
    }
}

}  // namespace

void contact_forces(Assembly& body, IndexRange contacts, const StepSettings& settings, long long step) {
    for (int c = contacts.begin; c < contacts.end; ++c) forces_of_contact(body, c, settings, step);
}

}  // namespace feldspar
