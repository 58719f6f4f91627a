// Dilation of a joint: closed faces that slide climb over each other.
//
// Coulomb friction with a flow rule that is not associated, as smooth joints of bonded-particle models have it: D. Mas Ivars and
// others, Int. J. Rock Mech. Min. Sci. 48 (2011). There the normal force follows the shear force of the trial; here both are
// solved together, so that |Fs| = mu Fn holds. docs/theory/heterogeneity.md, (H9)-(H11).
//   psi  dilation angle; tan psi <= mu          l  slip so far, m: the sum of all sliding, to and fro
//   L    slip after which dilation stops, m     e  opening by dilation, tan psi min(l, L), m
// A broken point carries Fn = -kn (un - e) while un < e. Its state keeps un - e in the place of un, so that everything else of
// the law, and its energies, are what they are without dilation. In a step, from the trial forces Fn', Fs' of the whole
// increments:
//     |Fs'| <= mu Fn'                                      sticks
//     dl = (|Fs'| - mu Fn') / (ks + mu kn tan psi),  Fn = Fn' + kn tan psi dl       slides; beyond L only what is left of L
//     dilates |Fs| = mu Fn                                         the strength is that of mu, whatever psi Fn <= 0 open: no
//     force, no slip
// Work of the shear force on the slip is mu Fn dl; tan psi Fn dl of it lifts the normal force. Friction takes (mu - tan psi) Fn
// dl >= 0.
#pragma once

#include "feldspar/laws/bond.hpp"

namespace feldspar {
/// How the faces of a joint climb over each other.
struct Dilation {
    double tan_psi = 0.0;  ///< 0 ... mu
    double slip_m = 0.0;   ///< L
};

/// Advances a broken point (damage = 1). @param slip_m  l: before, then after
FELDSPAR_HD inline void slide_with_dilation(const BondLawOf<double>& law, const Dilation& dilation, double area_m2, double dun_m,
                                            double dus_m, BondState& s, double& slip_m) {
    const double kn = law.Kn_Pa_m * area_m2, ks = law.Ks_Pa_m * area_m2, inverse_area = 1.0 / area_m2,
                 inverse_ks = law.inverse_Ks * inverse_area;
    const double Fn_before = s.Fn_N, Fs_before = s.Fs_N,
                 energy_before = normal_energy(law, inverse_area, s.Fn_N, s.un_m, s.damage);
    s.un_m += dun_m;
    s.us_m += dus_m;
    const double Fn_trial = -kn * s.un_m,
                 Fs_trial = Fs_before - ks * dus_m;  // less than 0: open, unless the faces climb until they meet
    const double beyond = std::abs(Fs_trial) - law.mu * Fn_trial, rise = kn * dilation.tan_psi,
                 left = larger(0.0, dilation.slip_m - slip_m);
    double opening = 0.0;
    if (beyond > 0.0 && ks > 0.0) {
        double dl = beyond / (ks + law.mu * rise);
        if (dl > left) dl = (beyond - law.mu * rise * left) / ks;  // it stops dilating on the way
        const double climbed = smaller(dl, left);
        if (Fn_trial + rise * climbed > 0.0) {
            opening = dilation.tan_psi * climbed;
            slip_m += dl;
        }
    }
    s.un_m -= opening;
    s.Fn_N = s.un_m < 0.0 ? -kn * s.un_m : 0.0;
    const double limit = law.mu * s.Fn_N;
    s.Fs_N = larger(smaller(Fs_trial, limit), -limit);
    const double lifted = 0.5 * (Fn_before + s.Fn_N) * opening;
    s.friction_J += -0.5 * (Fs_before + s.Fs_N) * dus_m + 0.5 * (Fs_before * Fs_before - s.Fs_N * s.Fs_N) * inverse_ks - lifted;
    s.fracture_J += -0.5 * (Fn_before + s.Fn_N) * dun_m + lifted + energy_before -
                    normal_energy(law, inverse_area, s.Fn_N, s.un_m, s.damage);  // 0 but where faces meet or part within the step
}

}  // namespace feldspar
