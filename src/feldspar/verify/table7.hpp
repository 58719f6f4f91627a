// The contact of Table 7 of the paper, for every check and test that wants it.
#pragma once

#include "feldspar/model/spec.hpp"

namespace feldspar::bodies {

inline ContactMaterial table7() {
    ContactMaterial c;
    c.Kn_Pa_m = 18e13;  // Table 1
    c.eta = 0.28;
    c.sigma_nt_Pa = 8.5e6;
    c.tau_Pa = 29.75e6;
    c.mu = 0.40;
    c.Gfn_J_m2 = 20.0;
    c.Gfs_J_m2 = 800.0;
    return c;
}

}  // namespace feldspar::bodies
