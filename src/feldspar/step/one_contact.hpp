// The contact stage of one contact in readable form. `Model` is an Assembly, or what has its members: a copy on a device (gpu/).
#pragma once

#include <type_traits>

#include "feldspar/model/attachment.hpp"

namespace feldspar {

/// Real strength, or, if `unlimited`, intact points that stay elastic.
FELDSPAR_HD inline BondEvent apply_law(const BondLawOf<double>& law, double area_m2, double dun, double dus, bool unlimited,
                                       BondState& bond) {
    if (unlimited && update_elastic(law, area_m2, dun, dus, bond)) return BondEvent::none;
    return update_bond(law, area_m2, dun, dus, bond);
}

/// The weights of a side: those of the current state, or the remembered ones of a flexible side that has fallen back.
template <class Attachment>
FELDSPAR_HD typename Attachment::Weights weights_of(const Attachment& side, Vec2 x, bool initial,
                                                    [[maybe_unused]] const std::array<double, 3>* remembered) {
    if constexpr (std::is_same_v<Attachment, TriangleAttachment>) {
        if (initial) return *remembered;
    }
    return side.at(x);
}

/// The one loop over contact points, whatever hangs on either side. Adds to both slots.
/// @param broke  called as broke(point, law, event, bond) when a point breaks; may change its bond
template <class AttachmentA, class AttachmentB, class Model, class Broke>
FELDSPAR_HD void forces_of_contact(Model& assembly, const Contact& contact, SlotForces& slot_a, SlotForces& slot_b, double dt,
                                   bool unlimited, const Broke& broke) {
    const ContactFrame frame = contact_frame(assembly, contact);
    const Vec2 s = rot90(frame.n);
    const AttachmentA a(assembly, contact.a);
    const AttachmentB b(assembly, contact.b);
    const BondLawOf<double> law = assembly.law_of(contact);

    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const auto& point = assembly.points[p];
        const Vec2 x = frame.reference_point + point.along_m * frame.edge_tangent;
        const InitialShape* initial = contact.initial_shape ? &assembly.initial_shapes[p] : nullptr;
        const auto Na = weights_of(a, x, contact.initial_shape, initial ? &initial->a : nullptr);
        const auto Nb = weights_of(b, x, contact.initial_shape, initial ? &initial->b : nullptr);
        const Vec2 relative = b.velocity(Nb) - a.velocity(Na);

        BondState bond = assembly.bond(p);
        const double dun = dt * dot(relative, frame.n), dus = dt * dot(relative, s);
        BondEvent event = BondEvent::none;
        if (contact.dilation >= 0 && bond.damage >= 1.0) {
            slide_with_dilation(law, assembly.dilations[contact.dilation], point.area_m2, dun, dus, bond, assembly.slip_m(p));
        } else {
            event = apply_law(law, point.area_m2, dun, dus, unlimited, bond);
        }
        if (event != BondEvent::none) broke(p, law, event, bond);
        assembly.set_bond(p, bond);
        const Vec2 on_b = bond.Fn_N * frame.n + bond.Fs_N * s;  // compression pushes B along n
        slot_a.add(-on_b, a.arm(Na, x));
        slot_b.add(on_b, b.arm(Nb, x));
    }
}

}  // namespace feldspar
