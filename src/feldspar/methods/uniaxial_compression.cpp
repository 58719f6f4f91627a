// Uniaxial compression: E, nu, UCS, crack initiation and crack damage stress (ISRM 1979, 1999; ASTM D7012).
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {

const TestMethod uniaxial_compression{
    .name = "uniaxial-compression",
    .purpose = "a specimen pressed between two platens, with free sides",
    .words = {"Uniaxial compression", "Axial stress", "Axial strain from the platens"},
    .build = between_its_platens,
    .start = {},
    .reading = Reading::column,
    .specimen = {},
    .loading =
        {.control = LoadControl::dissipation, .widens = true, .bends = true, .on_envelope = true, .failure_state = {{0.0, 1.0}}},
    .rate = {},
    .verdict = {},
    .strength = {"UCS", "Uniaxial compressive strength"},
    .job = {.title = "A uniaxial compression test.", .gives = "gives E, nu, UCS, crack initiation and crack damage stress"},
};

}  // namespace feldspar::methods
