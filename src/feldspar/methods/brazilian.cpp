// Brazilian test: BTS, the indirect tensile strength of a disc (ISRM 1978; ASTM D3967; flattened: Wang and Xing 1999).
#include "feldspar/methods/method.hpp"

namespace feldspar::methods {

const TestMethod brazilian{
    .kind = TestKind::brazilian,
    .purpose = "a disc pressed between two jaws until it splits",
    .specimen = {.own_disc = true, .plate_mu = 0.4},
    .loading = {.tensile = true},
    .rate = {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 250.0, .seconds = 8.0},
    .verdict = {.error_a = 1e-2, .imbalance_a = 3e-2, .imbalance_b = 5e-2},
};

}  // namespace feldspar::methods
