// Biaxial compression, the plane form of the triaxial test: strength at a confining pressure, and with others cohesion, friction angle and
// Hoek-Brown's mi (ISRM 1983; ASTM D7012).
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {

const TestMethod biaxial{
    .kind = TestKind::biaxial,
    .purpose = "isotropic consolidation, then axial loading at a constant pressure on the sides",
    .words = {"Biaxial compression", "Axial stress", "Axial strain from the platens"},
    .build = between_its_platens,
    .start = {},
    .reading = Reading::column,
    .specimen = {.confined = true},
    .loading = {.control = LoadControl::dissipation, .widens = true, .bends = true, .failure_state = {{0.0, 1.0}}},
    .rate = {.travel_times = 300.0, .seconds = 10.0},
    .verdict = {},
};

}  // namespace feldspar::methods
