#include "feldspar/step/advance_packs.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

namespace {

void advance_readably(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count,
                      PlatenWork& work) {
    const int contacts = static_cast<int>(assembly.contacts.size()), bodies = static_cast<int>(assembly.bodies.size());
    const double travel = settings.dt * settings.speed;
    team.run([&](int thread) {
        for (int k = 0; k < count; ++k) {
            contact_forces(assembly, team.share(contacts, thread), settings, first_step + k);
            team.barrier();
            body_forces(assembly, team.share(bodies, thread), settings);
            team.barrier();
            // What moves the body pushes with the opposite of its reaction along its motion. Meanwhile the others may go on: node
            // forces stay as they are until the barrier after the next contact stage.
            if (thread == 0) work.loading += loading_reaction(assembly) * travel;
        }
    });
}

}  // namespace

void StepSequence::advance(const StepSettings& settings, long long first_step, int count, PlatenWork& work) {
    if (settings.device != nullptr) return settings.device->advance(assembly_, team_, settings, first_step, count, work);
    if (settings.kernels == nullptr) return advance_readably(assembly_, team_, settings, first_step, count, work);
    if (!arrays_) {
        sort_out_packs(assembly_);
        arrays_.emplace(assembly_);
        write_lines(assembly_, team_, settings, *arrays_);
    }
    advance_packs(assembly_, team_, settings, *arrays_, first_step, count, work);
}

void advance(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count, PlatenWork& work) {
    StepSequence(assembly, team).advance(settings, first_step, count, work);
}

void evaluate_forces(Assembly& assembly, Team& team, Strength strength) {
    StepSettings still;
    still.dt = 0.0;
    still.strength = strength;
    PlatenWork none;
    advance(assembly, team, still, 0, 1, none);
}

}  // namespace feldspar
