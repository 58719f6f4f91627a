// Cyclic uniaxial compression, controlled by damage: the specimen is unloaded each time that it has grown wider by a step, and loaded again, on past
// its strength (Martin and Chandler 1994). What each cycle shows is read by lab/cycles.
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {
namespace {

std::vector<StageGroup> cycles(const TestSpec& test) {
    StageSpec load{.kind = StageKind::load, .end = StageEnd::lateral_strain, .value = test.cycles.lateral_strain_step, .counts = StageValue::beyond};
    if (test.cycles.stress_step_Pa) {
        load.end = StageEnd::stress;
        load.value = *test.cycles.stress_step_Pa;
    }
    const StageSpec unload{.kind = StageKind::unload, .end = StageEnd::share_of_peak, .value = test.cycles.unload_to};
    std::vector<StageGroup> groups{{{load, unload}, test.cycles.count}};
    if (test.cycles.count > 0) groups.push_back({{StageSpec{}}});
    return groups;
}

const MethodBuild build{between_platens, height_m, narrowest_section_m2, nullptr, {}, nullptr, cycles};

}  // namespace

const TestMethod cyclic_compression{
    .kind = TestKind::cyclic_compression,
    .purpose = "a specimen pressed between two platens, unloaded and loaded again at each step of its widening",
    .words = {"Cyclic compression", "Axial stress", "Axial strain from the platens"},
    .build = build,
    .start = {},
    .reading = Reading::column,
    .specimen = {},
    .loading = {.control = LoadControl::dissipation, .widens = true, .bends = true, .failure_state = {{0.0, 1.0}}},
    .rate = {.seconds = 20.0},
    .verdict = {},
};

}  // namespace feldspar::methods
