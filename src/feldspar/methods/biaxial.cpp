// Biaxial compression, the plane form of the triaxial test: strength at a confining pressure, and with others cohesion, friction
// angle and Hoek-Brown's mi (ISRM 1983; ASTM D7012).
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {

const TestMethod biaxial{
    .name = "biaxial",
    .purpose = "isotropic consolidation, then axial loading at a constant pressure on the sides",
    .words = {"Biaxial compression", "Axial stress", "Axial strain from the platens"},
    .build = between_its_platens,
    .start = {},
    .reading = Reading::column,
    .specimen = {.confined = true},
    .loading =
        {.control = LoadControl::dissipation, .widens = true, .bends = true, .on_envelope = true, .failure_state = {{0.0, 1.0}}},
    .rate = {.seconds = 10.0},  // steps without the plateau: as without a pressure (lab/foresee)
    .verdict = {},
    .job =
        {.title = "Biaxial tests at two confining stresses and a uniaxial one: the strength envelope.",
         .gives = "isotropic consolidation, then axial loading at constant sigma3",
         .keys =
             R"(sigma3 = ["4 MPa", "10 MPa"]        # one test for each; with a uniaxial test they give cohesion, friction angle and mi
)",
         .behind = &uniaxial_compression},  // the envelope needs the uniaxial point
};

}  // namespace feldspar::methods
