// Multi-stage biaxial compression: one specimen under rising pressures. Under each but the last it is loaded until its volumetric
// strain turns, under the last to failure (after Kovari, Tisa, Einstein and Franklin 1983, ISRM). What it shows is read by
// lab/multi_stage.
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {
namespace {

std::vector<StageGroup> pressures(const TestSpec& test) {
    std::vector<StageGroup> groups;
    for (const double sigma3_Pa : test.later_sigma3_Pa) {
        groups.push_back({{StageSpec{.kind = StageKind::load, .end = StageEnd::reversal}}});
        groups.push_back({{StageSpec{.kind = StageKind::confine, .sigma3_Pa = sigma3_Pa}}});
    }
    groups.push_back({{StageSpec{}}});
    return groups;
}

const MethodBuild build{between_platens, height_m, narrowest_section_m2, nullptr, {}, nullptr, pressures};

}  // namespace

const TestMethod multi_stage_biaxial{
    .name = "multi-stage-biaxial",
    .purpose = "one specimen under rising pressures on its sides, loaded under each until it dilates, under the last to failure",
    .words = {"Multi-stage biaxial compression", "Axial stress", "Axial strain from the platens"},
    .build = build,
    .start = {},
    .reading = Reading::stages,
    .specimen = {.confined = true},
    .loading = {.control = LoadControl::dissipation, .widens = true, .bends = true, .failure_state = {{0.0, 1.0}}},
    .rate = {.travel_times = 300.0, .seconds = 20.0},
    .verdict = {},
    .job =
        {.title = "A strength envelope from one specimen.",
         .gives = "one specimen under rising pressures: loaded under each until it dilates, under the last to failure",
         .keys =
             R"(sigma3 = ["2 MPa", "5 MPa", "10 MPa"]   # strengths under all but the last are estimated; cohesion and friction angle from them

# What no laboratory can do: the same packings under one pressure each, for comparison.
# [[test]]
# kind = "biaxial"
# sigma3 = ["2 MPa", "5 MPa", "10 MPa"]
)"},
};

}  // namespace feldspar::methods
