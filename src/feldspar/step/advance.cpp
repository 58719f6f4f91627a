#include "feldspar/step/step.hpp"

namespace feldspar {

void advance(Assembly& body, Team& team, const StepSettings& settings, long long first_step, int count, PlatenWork& work) {
    const int contacts = static_cast<int>(body.contacts.size()), grains = static_cast<int>(body.grains.size());
    const double travel = settings.dt * settings.speed;
    team.run([&](int thread) {
        for (int k = 0; k < count; ++k) {
            contact_forces(body, team.share(contacts, thread), settings, first_step + k);
            team.barrier();
            grain_forces(body, team.share(grains, thread), settings);
            team.barrier();
            if (thread == 0) {
                for (Platen& platen : body.platens) platen.position_m += travel * platen.mode.y;
                // The platen pushes with the opposite of its reaction along its mode.
                work.loading -= platen_reactions(body).loading * body.platens[0].mode.y * travel;
            }
            team.barrier();   // the next contact stage overwrites the slots that the reactions are read from
        }
    });
}

void evaluate_forces(Assembly& body, Team& team, Strength strength) {
    StepSettings still;
    still.dt = 0.0;
    still.strength = strength;
    PlatenWork none;
    advance(body, team, still, 0, 1, none);
}

}  // namespace feldspar
