// A point of a broken joint that dilates, sheared under a constant normal stress or behind a spring; for checks and tests.
#pragma once

#include "feldspar/laws/dilation.hpp"
#include "feldspar/verify/table7.hpp"

namespace feldspar::bodies {

inline constexpr double kArea = 8e-5, kStress = 5e6, kMu = 0.5, kTanPsi = 0.2, kLimit = 1e-4;
inline constexpr Dilation kDilation{kTanPsi, kLimit};

struct Sheared {
    double opening_m = 0.0, shear_N = 0.0, normal_N = 0.0, work_J = 0.0, slip_m = 0.0, stored_J = 0.0;
    BondState state;
};

/// A broken joint under a normal stress, sheared by `reach`. @param stiffness_Pa_m  of what presses it: 0, a constant stress
inline Sheared shear(double reach_m, double stiffness_Pa_m, int steps = 4000) {
    ContactMaterial m = bodies::table7();
    m.sigma_nt_Pa = m.tau_Pa = 0.0;
    m.mu = kMu;
    const BondLaw law = BondLaw::make(m);
    const double kn = law.Kn_Pa_m * kArea, K = stiffness_Pa_m * kArea;
    Sheared r;
    r.state.damage = 1.0;
    r.state.un_m = -kStress * kArea / kn;
    r.state.Fn_N = kStress * kArea;
    const double stored = elastic_energy(law, kArea, r.state);
    double un = 0.0;  // since then
    for (int k = 0; k < steps; ++k) {
        const double du = reach_m / steps, Fn_before = r.state.Fn_N, Fs_before = r.state.Fs_N;
        // The opening at which what presses it and the joint are in balance: both forces fall or grow with it.
        double low = -1e-5, high = 1e-5;
        BondState after;
        double slip = 0.0, dun = 0.0;
        for (int i = 0; i < 80; ++i) {
            dun = 0.5 * (low + high);
            after = r.state;
            slip = r.slip_m;
            slide_with_dilation(law, kDilation, kArea, dun, du, after, slip);
            (after.Fn_N > kStress * kArea + K * (un + dun) ? low : high) = dun;
        }
        un += dun;
        r.state = after;
        r.slip_m = slip;
        r.work_J -= 0.5 * (Fn_before + after.Fn_N) * dun + 0.5 * (Fs_before + after.Fs_N) * du;
    }
    r.opening_m = un;
    r.shear_N = -r.state.Fs_N;
    r.normal_N = r.state.Fn_N;
    r.stored_J = elastic_energy(law, kArea, r.state) - stored;
    return r;
}

}  // namespace feldspar::bodies
