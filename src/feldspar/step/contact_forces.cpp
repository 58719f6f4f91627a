#include "feldspar/step/one_contact.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

void contact_forces(Assembly& assembly, IndexRange contacts, const StepSettings& settings, long long step) {
    const auto broke = [&](int p, const BondLawOf<double>& law, BondEvent event, BondState& bond) {
        note_break(assembly.points[p], law, event, step, bond);
    };
    for (int c = contacts.begin; c < contacts.end; ++c) {
        const Contact& contact = assembly.contacts[c];
        SlotForces& slot_a = assembly.slots[2 * c];
        SlotForces& slot_b = assembly.slots[2 * c + 1];
        slot_a = slot_b = SlotForces{};
        if (contact.dropped) continue;
        with_attachments(contact, [&]<class A, class B>() {
            forces_of_contact<A, B>(assembly, contact, slot_a, slot_b, settings.dt, settings.strength == Strength::unlimited,
                                    broke);
        });
    }
}

}  // namespace feldspar
