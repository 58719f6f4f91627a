// Cyclic uniaxial compression, controlled by damage: the specimen is unloaded each time that it has grown wider by a step, and
// loaded again, on past its strength (Martin and Chandler 1994). What each cycle shows is read by lab/cycles.
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {
namespace {

constexpr double kLateralStep = 2e-4, kUnloadTo = 0.02;  // the specimen stays in touch
constexpr Range inside_one{0.0, 1.0, false, false, "greater than 0 and less than 1"};

constexpr MethodKey kKeys[]{
    {.name = "lateral_strain_step",
     .form = MethodKeyForm::share,
     .range = inside_one,
     .value = kLateralStep,
     .meaning = "the specimen is unloaded each time that it has become so much wider"},
    {.name = "stress_step",
     .dimension = Dimension::stress,
     .usual = "none",
     .meaning = "the specimen is unloaded each time that the stress has grown by so much, in place of `lateral_strain_step`",
     .in_place_of = "lateral_strain_step"},
    {.name = "cycles",
     .form = MethodKeyForm::whole,
     .range = {0.0, 10000.0, true, true, "0 to 10000"},
     .value = 0.0,
     .meaning = "cycles of loading and unloading, after which it is loaded until the test ends; 0: until the test ends"},
    {.name = "unload_to",
     .form = MethodKeyForm::share,
     .range = inside_one,
     .value = kUnloadTo,
     .meaning = "share of the largest load at which unloading ends"},
};

std::vector<StageGroup> cycles(const TestSpec& test) {
    StageSpec load{.kind = StageKind::load,
                   .end = StageEnd::lateral_strain,
                   .value = test.own_value("lateral_strain_step").value_or(kLateralStep),
                   .counts = StageValue::beyond};
    if (const auto step_Pa = test.own_value("stress_step")) {
        load.end = StageEnd::stress;
        load.value = *step_Pa;
    }
    const int count = static_cast<int>(test.own_value("cycles").value_or(0.0));
    const StageSpec unload{
        .kind = StageKind::unload, .end = StageEnd::share_of_peak, .value = test.own_value("unload_to").value_or(kUnloadTo)};
    std::vector<StageGroup> groups{{{load, unload}, count}};
    if (count > 0) groups.push_back({{StageSpec{}}});
    return groups;
}

const MethodBuild build{between_platens, height_m, narrowest_section_m2, nullptr, {}, nullptr, cycles};

}  // namespace

const TestMethod cyclic_compression{
    .name = "cyclic-compression",
    .purpose = "a specimen pressed between two platens, unloaded and loaded again at each step of its widening",
    .words = {"Cyclic compression", "Axial stress", "Axial strain from the platens"},
    .build = build,
    .start = {},
    .reading = Reading::column,
    .specimen = {},
    .loading = {.control = LoadControl::dissipation, .widens = true, .bends = true, .failure_state = {{0.0, 1.0}}},
    .rate = {.seconds = 20.0},
    .verdict = {},
    .strength = {"UCS_cyclic", "Uniaxial compressive strength under cycles", "UCS cyclic", "UCS"},
    .keys = kKeys,
    .job =
        {.title = "A cyclic compression test, controlled by damage.",
         .gives = "unloaded and loaded again, on past the strength: moduli, permanent strains and damage of each cycle",
         .keys =
             R"(lateral_strain_step = "0.02 %"      # unloads each time that the specimen has grown wider by so much; or stress_step = "20 MPa"
#= cycles
#= unload_to
)"},
};

}  // namespace feldspar::methods
