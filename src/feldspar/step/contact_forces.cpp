#include <algorithm>
#include <type_traits>

#include "feldspar/model/attachment.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {
namespace {

BondEvent apply_law(const BondLaw& law, double area_m2, double dun, double dus, Strength strength, BondState& bond) {
    if (strength == Strength::unlimited && update_elastic(law, area_m2, dun, dus, bond)) return BondEvent::none;
    return update_bond(law, area_m2, dun, dus, bond);
}

// The weights of a side: those of the current state, or the remembered ones of a flexible side that has fallen back.
template <class Attachment>
typename Attachment::Weights weights(const Attachment& side, Vec2 x, bool initial, [[maybe_unused]] const std::array<double, 3>* remembered) {
    if constexpr (std::is_same_v<Attachment, TriangleAttachment>) {
        if (initial) return *remembered;
    }
    return side.at(x);
}

// The one loop over contact points, whatever hangs on either side.
template <class AttachmentA, class AttachmentB>
void forces_of_contact(Assembly& assembly, const Contact& contact, SlotForces& slot_a, SlotForces& slot_b, const StepSettings& settings,
                       long long step) {
    const ContactFrame frame = contact_frame(assembly, contact);
    const Vec2 s = rot90(frame.n);
    const AttachmentA a(assembly, contact.a);
    const AttachmentB b(assembly, contact.b);
    const BondLaw law = assembly.law_of(contact);

    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        ContactPoint& point = assembly.points[p];
        const Vec2 x = frame.reference_point + point.along_m * frame.edge_tangent;
        const InitialShape* initial = contact.initial_shape ? &assembly.initial_shapes[p] : nullptr;
        const auto Na = weights(a, x, contact.initial_shape, initial ? &initial->a : nullptr);
        const auto Nb = weights(b, x, contact.initial_shape, initial ? &initial->b : nullptr);
        const Vec2 relative = b.velocity(Nb) - a.velocity(Na);

        BondState bond = assembly.bond(p);
        const double dun = settings.dt * dot(relative, frame.n), dus = settings.dt * dot(relative, s);
        BondEvent event = BondEvent::none;
        if (contact.dilation >= 0 && bond.damage >= 1.0)
            slide_with_dilation(law, assembly.dilations[contact.dilation], point.area_m2, dun, dus, bond, assembly.bonds.slip_m[point.state]);
        else event = apply_law(law, point.area_m2, dun, dus, settings.strength, bond);
        if (event != BondEvent::none) note_break(point, law, event, step, bond);
        assembly.set_bond(p, bond);
        const Vec2 on_b = bond.Fn_N * frame.n + bond.Fs_N * s;   // compression pushes B along n
        slot_a.add(-on_b, a.arm(Na, x));
        slot_b.add(on_b, b.arm(Nb, x));
    }
}

}  // namespace

void contact_forces(Assembly& assembly, IndexRange contacts, const StepSettings& settings, long long step) {
    for (int c = contacts.begin; c < contacts.end; ++c) {
        const Contact& contact = assembly.contacts[c];
        SlotForces& slot_a = assembly.slots[2 * c];
        SlotForces& slot_b = assembly.slots[2 * c + 1];
        slot_a = slot_b = SlotForces{};
        if (contact.dropped) continue;
        with_attachments(contact,
                         [&]<class A, class B>() { forces_of_contact<A, B>(assembly, contact, slot_a, slot_b, settings, step); });
    }
}

}  // namespace feldspar
