// The law of a contact point: cohesive bond that softens and breaks, then Coulomb friction.
//
// Source: paper, equations (13)-(19) and (22)-(27), figure 3; restored in docs/theory/contacts.md.
//   un  normal gap, m, > 0 open           Fn  normal force, N, compression positive
//   us  shear displacement, m             Fs  shear force, N, on side A along the tangent with the sign of -us
//   k   Kn A and eta Kn A                 D   damage, 0 intact ... 1 broken, never decreases
// While D = 0:  Fn = -kn un, Fs = -ks us.
// While D < 1 (forces are incremental, so tension unloads with the slope kn from the current point):
//     trial    Fn' = Fn - kn dun,  Fs' = Fs - ks dus
//     D        = min(1, Dn(max un) + Ds(max |us|))                               (26)-(27), which must mean 1 - D
//     tension  Fn  = max(Fn', -(1 - D) sigma_nt A)
//     shear    |Fs| <= (1 - D) tau A + mu max(Fn, 0)                             (25)
//     a brittle direction breaks (D = 1) when its trial force passes its limit, the friction part included
// When D = 1:  Fn = -kn un for un < 0, else 0;  |Fs| <= mu Fn, still incremental.
// A crack is tensile if the trial normal force was tensile when D became 1, shear otherwise.
// Deviations from the paper, each an option or a decision recorded in docs/decisions: the shear measure (total |us|, or what
// is left of it beyond friction), the unloading in tension (slope kn, or secant to the origin), the reading of figure 3.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/laws/softening.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// A contact material made ready: everything is per area, so that points differ by their area alone.
struct BondLaw {
    double Kn_Pa_m = 0.0;
    double Ks_Pa_m = 0.0;
    double sigma_nt_Pa = 0.0;
    double tau_Pa = 0.0;
    double mu = 0.0;
    SofteningEnvelope normal;
    SofteningEnvelope shear;
    bool shear_beyond_friction = false;
    bool secant_unloading = false;

    static BondLaw make(const ContactMaterial& m) {
        BondLaw law;
        law.Kn_Pa_m = m.Kn_Pa_m;
        law.Ks_Pa_m = m.eta * m.Kn_Pa_m;
        law.sigma_nt_Pa = m.sigma_nt_Pa;
        law.tau_Pa = m.tau_Pa;
        law.mu = m.mu;
        law.normal = SofteningEnvelope::make(m.law, m.sigma_nt_Pa, law.Kn_Pa_m, m.Gfn_J_m2);
        law.shear = SofteningEnvelope::make(m.law, m.tau_Pa, law.Ks_Pa_m, m.Gfs_J_m2);
        law.shear_beyond_friction = m.shear_measure == ShearMeasure::beyond_friction;
        law.secant_unloading = m.tension_unloading == TensionUnloading::secant;
        return law;
    }

    /// Stays elastic whatever happens: contacts inside a grain of inner particles, glued plates. eta = 0: free in shear.
    static BondLaw unbreakable(double Kn_Pa_m, double eta) {
        constexpr double kNever = std::numeric_limits<double>::infinity();
        BondLaw law;
        law.Kn_Pa_m = Kn_Pa_m;
        law.Ks_Pa_m = eta * Kn_Pa_m;
        law.sigma_nt_Pa = law.tau_Pa = kNever;
        law.normal.x0 = law.shear.x0 = kNever;
        return law;
    }
};

/// What a contact point remembers.
struct BondState {
    double un_m = 0.0;
    double us_m = 0.0;
    double Fn_N = 0.0;
    double Fs_N = 0.0;
    double max_un_m = 0.0;
    double max_us_m = 0.0;
    double damage = 0.0;
    double fracture_J = 0.0;   ///< dissipated by softening and breaking
    double friction_J = 0.0;   ///< dissipated by sliding
};

/// What an update tells besides the state.
enum class BondEvent { none, broke_in_tension, broke_in_shear, broke_in_shear_losing_compression };

/// How a point broke whose trial normal force is Fn_trial at the gap un. Unloading with the slope kn may have left compression at an open
/// gap, which vanishes then.
[[gnu::always_inline]] inline BondEvent how_it_broke(double Fn_trial_N, double un_m) {
    if (Fn_trial_N < 0.0) return BondEvent::broke_in_tension;
    return Fn_trial_N > 0.0 && un_m > 0.0 ? BondEvent::broke_in_shear_losing_compression : BondEvent::broke_in_shear;
}

/// Recoverable energy of a point, J.
inline double elastic_energy(const BondLaw& law, double area_m2, const BondState& s) {
    const double shear = law.Ks_Pa_m > 0.0 ? 0.5 * s.Fs_N * s.Fs_N / (law.Ks_Pa_m * area_m2) : 0.0;
    if (law.secant_unloading && s.un_m > 0.0 && s.damage > 0.0) return 0.5 * std::abs(s.Fn_N) * s.un_m + shear;
    return 0.5 * s.Fn_N * s.Fn_N / (law.Kn_Pa_m * area_m2) + shear;
}

/// Elastic update with unlimited strength for intact points (the elastic start); broken points obey the real law.
/// @return true if the state is final, false if the real law has to be applied.
inline bool update_elastic(const BondLaw& law, double area_m2, double dun_m, double dus_m, BondState& s) {
    if (s.damage >= 1.0) return false;
    s.un_m += dun_m;
    s.us_m += dus_m;
    s.Fn_N = s.damage == 0.0 ? -(law.Kn_Pa_m * area_m2) * s.un_m : s.Fn_N - law.Kn_Pa_m * area_m2 * dun_m;
    s.Fs_N = s.damage == 0.0 ? -(law.Ks_Pa_m * area_m2) * s.us_m : s.Fs_N - law.Ks_Pa_m * area_m2 * dus_m;
    return true;
}

namespace detail {

// The branch of update_bond for points that are damaged, or about to be.
inline BondEvent update_damaged(const BondLaw& law, double area_m2, double dun_m, double dus_m, BondState& s) {
    const double kn = law.Kn_Pa_m * area_m2, ks = law.Ks_Pa_m * area_m2;
    const double energy_before = elastic_energy(law, area_m2, s);
    const double Fn_before = s.Fn_N, Fs_before = s.Fs_N;
    const bool broken_before = s.damage >= 1.0;
    const double Fn_trial = s.Fn_N - kn * dun_m;
    const double Fs_trial = s.Fs_N - ks * dus_m;
    s.un_m += dun_m;
    s.us_m += dus_m;

    double friction_limit = 0.0, cohesion_limit = 0.0;
    BondEvent event = BondEvent::none;
    if (!broken_before) {
        double measure = std::abs(s.us_m);
        if (law.shear_beyond_friction) measure -= law.mu * std::max(Fn_trial, 0.0) / ks;
        s.max_un_m = std::max(s.max_un_m, s.un_m);
        s.max_us_m = std::max(s.max_us_m, measure);
        s.damage = std::max(s.damage, std::min(1.0, law.normal.damage(s.max_un_m) + law.shear.damage(s.max_us_m)));

        const double tension_limit = (1.0 - s.damage) * law.sigma_nt_Pa * area_m2;
        cohesion_limit = (1.0 - s.damage) * law.tau_Pa * area_m2;
        if (law.normal.brittle && Fn_trial < -tension_limit) s.damage = 1.0;
        if (law.shear.brittle && std::abs(Fs_trial) > cohesion_limit + law.mu * std::max(Fn_trial, 0.0)) s.damage = 1.0;
        if (s.damage < 1.0) {
            s.Fn_N = std::max(Fn_trial, -tension_limit);
            if (law.secant_unloading && s.un_m > 0.0 && s.max_un_m > law.normal.x0)
                s.Fn_N = -tension_limit * s.un_m / s.max_un_m;
        } else {
            event = how_it_broke(Fn_trial, s.un_m);
        }
    }
    if (s.damage >= 1.0) {
        s.Fn_N = s.un_m < 0.0 ? -kn * s.un_m : 0.0;
        cohesion_limit = 0.0;
    }
    friction_limit = law.mu * std::max(s.Fn_N, 0.0);
    const double limit = cohesion_limit + friction_limit;
    s.Fs_N = std::clamp(Fs_trial, -limit, limit);

    // Work done on the point minus what it keeps (docs/theory/contacts.md): the normal part and the cohesive share of the
    // sliding are fracture, the frictional share is friction.
    const double work_n = -0.5 * (Fn_before + s.Fn_N) * dun_m;
    const double work_s = -0.5 * (Fs_before + s.Fs_N) * dus_m;
    const double shear_before = 0.5 * Fs_before * Fs_before / ks, shear_after = 0.5 * s.Fs_N * s.Fs_N / ks;
    const double dissipated_s = work_s + shear_before - shear_after;
    const double dissipated_n = work_n + (energy_before - shear_before) - (elastic_energy(law, area_m2, s) - shear_after);
    const double friction_share = broken_before ? 1.0 : (limit > 0.0 ? friction_limit / limit : 0.0);
    s.friction_J += friction_share * dissipated_s;
    s.fracture_J += dissipated_n + (1.0 - friction_share) * dissipated_s;
    return event;
}

}  // namespace detail

/// A bond that has just broken between bodies that did not touch each other, but were joined over a free gap: from now on they
/// push each other only when they meet. The energy of the compression that vanishes is booked as fracture.
inline void free_gap(const BondLaw& law, double area_m2, double gap_m, BondState& s) {
    const double before = elastic_energy(law, area_m2, s);
    s.un_m += gap_m;
    s.Fn_N = s.un_m < 0.0 ? -law.Kn_Pa_m * area_m2 * s.un_m : 0.0;
    const double limit = law.mu * s.Fn_N;
    s.Fs_N = std::clamp(s.Fs_N, -limit, limit);
    s.fracture_J += before - elastic_energy(law, area_m2, s);
}

/// Advances a point by the increments of its gap and its shear displacement.
/// @param area_m2  A_J, the point's share of the contact area
/// @param dun_m    gap increment, opening positive
inline BondEvent update_bond(const BondLaw& law, double area_m2, double dun_m, double dus_m, BondState& s) {
    // An undamaged point below both elastic limits is linear, and most points are that most of the time. A brittle
    // direction may sit on its limit, which the damaged branch then tells.
    const double un = s.un_m + dun_m, us = s.us_m + dus_m;
    if (s.damage == 0.0 && un <= law.normal.x0 && std::abs(us) <= law.shear.x0) {
        s.un_m = un;
        s.us_m = us;
        s.Fn_N = -(law.Kn_Pa_m * area_m2) * un;
        s.Fs_N = -(law.Ks_Pa_m * area_m2) * us;
        return BondEvent::none;
    }
    return detail::update_damaged(law, area_m2, dun_m, dus_m, s);
}

}  // namespace feldspar
