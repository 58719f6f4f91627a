#include "feldspar/step/advance_packs.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

void advance(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count, PlatenWork& work) {
    const int contacts = static_cast<int>(assembly.contacts.size()), bodies = static_cast<int>(assembly.bodies.size());
    const double travel = settings.dt * settings.speed;
    if (settings.kernels != nullptr) return advance_packs(assembly, team, settings, first_step, count, work);
    team.run([&](int thread) {
        for (int k = 0; k < count; ++k) {
            contact_forces(assembly, team.share(contacts, thread), settings, first_step + k);
            team.barrier();
            body_forces(assembly, team.share(bodies, thread), settings);
            team.barrier();
            // The platen pushes with the opposite of its reaction along its mode. Meanwhile the others may go on: node forces stay
            // as they are until the barrier after the next contact stage.
            if (thread == 0) work.loading -= platen_reactions(assembly).loading * assembly.platens[0].mode.y * travel;
        }
    });
}

void evaluate_forces(Assembly& assembly, Team& team, Strength strength) {
    StepSettings still;
    still.dt = 0.0;
    still.strength = strength;
    PlatenWork none;
    advance(assembly, team, still, 0, 1, none);
}

}  // namespace feldspar
