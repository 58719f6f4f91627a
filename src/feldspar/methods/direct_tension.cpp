// Direct tension: E, nu, DTS (ISRM 1978; ASTM D2936).
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {

const TestMethod direct_tension{
    .name = "direct-tension",
    .purpose = "a specimen pulled apart by its ends",
    .words = {"Direct tension", "Axial stress", "Axial strain from the platens"},
    .build = between_its_platens,
    .start = {},
    .reading = Reading::column,
    .specimen = {.glued = true},
    .loading = {.sign = -1.0, .tensile = true, .failure_state = {{-1.0, 0.0}}},
    .rate =
        {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 28.0, .seconds = 3.0, .fixed_speed_strain = 5e-4},
    .verdict = {.error_a = 1e-2},
    .strength = {"DTS", "Direct tensile strength"},
    .job = {.title = "A direct tension test.", .gives = "gives the direct tensile strength DTS"},
};

}  // namespace feldspar::methods
