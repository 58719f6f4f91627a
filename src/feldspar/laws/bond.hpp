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
// The text is written over a number type: double in the readable stages, a vector of contacts in the kernels of fast/.
// A crack is tensile if the trial normal force was tensile when D became 1, shear otherwise.
// Deviations from the paper, each an option or a decision recorded in docs/decisions: the shear measure (total |us|, or what
// is left of it beyond friction), the unloading in tension (slope kn, or secant to the origin), the reading of figure 3.
#pragma once

#include <cmath>
#include <limits>

#include "feldspar/laws/number.hpp"
#include "feldspar/laws/softening.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// A contact material made ready: everything is per area, so that points differ by their area alone. What a step would divide by
/// is inverted.
/// @tparam Number  double: one law; a vector of doubles: a law a lane
template <class Number>
struct BondLawOf {
    Number Kn_Pa_m{};
    Number Ks_Pa_m{};
    Number inverse_Kn{};  ///< m/Pa
    Number inverse_Ks{};  ///< m/Pa; 0 without shear stiffness
    Number sigma_nt_Pa{};
    Number tau_Pa{};
    Number mu{};
    SofteningEnvelopeOf<Number> normal;
    SofteningEnvelopeOf<Number> shear;
    bool shear_beyond_friction = false;
    bool secant_unloading = false;

    FELDSPAR_LAW void set_stiffness(Number Kn, Number Ks) {
        Kn_Pa_m = Kn;
        Ks_Pa_m = Ks;
        inverse_Kn = Kn > Number{} ? 1.0 / Kn : Number{};  // none in lanes without a contact
        inverse_Ks = Ks > Number{} ? 1.0 / Ks : Number{};
    }
};

/// One law, of all contacts of a class.
struct BondLaw : BondLawOf<double> {
    BondLaw() = default;
    explicit BondLaw(const BondLawOf<double>& law) : BondLawOf<double>(law) {}

    static BondLaw make(const ContactMaterial& m) {
        BondLaw law;
        law.set_stiffness(m.Kn_Pa_m, m.eta * m.Kn_Pa_m);
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
        law.set_stiffness(Kn_Pa_m, eta * Kn_Pa_m);
        law.sigma_nt_Pa = law.tau_Pa = kNever;
        law.normal.x0 = law.shear.x0 = kNever;
        return law;
    }

    /// Has no strength: a contact with a plate.
    static BondLaw frictional(double Kn_Pa_m, double eta, double mu) {
        BondLaw law;
        law.set_stiffness(Kn_Pa_m, eta * Kn_Pa_m);
        law.mu = mu;
        return law;
    }
};

/// What all laws that contacts have of their own share.
struct LawForm {
    ContactLaw law = ContactLaw::bilinear;
    bool shear_beyond_friction = false;
    bool secant_unloading = false;
};

/// The constants of a law that a contact has of its own; everything else of it follows from them.
template <class Number>
struct LawConstants {
    Number Kn_Pa_m{}, Ks_Pa_m{};
    Number x0_normal{}, x0_shear{};      ///< m, ends of the elastic branches
    Number x_fl_normal{}, x_fl_shear{};  ///< m, 2 Gf over the strength
    Number mu{};
};

/// The constants of a material. One without strength in a direction is brittle there.
inline LawConstants<double> law_constants(const ContactMaterial& m) {
    const double Ks = m.eta * m.Kn_Pa_m;
    const auto over = [](double Gf, double strength) { return strength > 0.0 ? 2.0 * Gf / strength : 0.0; };
    return {m.Kn_Pa_m, Ks, m.sigma_nt_Pa / m.Kn_Pa_m, m.tau_Pa / Ks, over(m.Gfn_J_m2, m.sigma_nt_Pa), over(m.Gfs_J_m2, m.tau_Pa),
            m.mu};
}

/// The law of these constants.
template <class Number>
FELDSPAR_LAW BondLawOf<Number> bond_law(const LawForm& form, const LawConstants<Number>& c) {
    BondLawOf<Number> law;
    law.set_stiffness(c.Kn_Pa_m, c.Ks_Pa_m);
    law.sigma_nt_Pa = c.Kn_Pa_m * c.x0_normal;
    law.tau_Pa = c.Ks_Pa_m * c.x0_shear;
    law.mu = c.mu;
    law.normal = SofteningEnvelopeOf<Number>::from(form.law, c.x0_normal, c.x_fl_normal);
    law.shear = SofteningEnvelopeOf<Number>::from(form.law, c.x0_shear, c.x_fl_shear);
    law.shear_beyond_friction = form.shear_beyond_friction;
    law.secant_unloading = form.secant_unloading;
    return law;
}

/// What a contact point remembers.
template <class Real>
struct BondStateOf {
    Real un_m{};
    Real us_m{};
    Real Fn_N{};
    Real Fs_N{};
    Real max_un_m{};
    Real max_us_m{};
    Real damage{};
    Real fracture_J{};  ///< dissipated by softening and breaking
    Real friction_J{};  ///< dissipated by sliding
};
using BondState = BondStateOf<double>;

/// What an update tells besides the state.
enum class BondEvent { none, broke_in_tension, broke_in_shear, broke_in_shear_losing_compression };

/// How a point broke whose trial normal force is Fn_trial at the gap un. Unloading with the slope kn may have left compression at
/// an open gap, which vanishes then.
FELDSPAR_LAW BondEvent how_it_broke(double Fn_trial_N, double un_m) {
    if (Fn_trial_N < 0.0) return BondEvent::broke_in_tension;
    return Fn_trial_N > 0.0 && un_m > 0.0 ? BondEvent::broke_in_shear_losing_compression : BondEvent::broke_in_shear;
}

/// Recoverable energy of the normal force, J.
template <class Number, class Real>
FELDSPAR_LAW Real normal_energy(const BondLawOf<Number>& law, Real inverse_area, Real Fn, Real un, Real damage) {
    const Real none{}, energy = 0.5 * law.inverse_Kn * inverse_area * Fn * Fn;
    if (!law.secant_unloading) return energy;
    return ((un > none) & (damage > none)) ? 0.5 * NumberOf<Real>::absolute(Fn) * un : energy;
}

/// Recoverable energy of a point, J.
FELDSPAR_HD inline double elastic_energy(const BondLawOf<double>& law, double area_m2, const BondState& s) {
    const double inverse_area = 1.0 / area_m2;
    return normal_energy(law, inverse_area, s.Fn_N, s.un_m, s.damage) + 0.5 * law.inverse_Ks * inverse_area * s.Fs_N * s.Fs_N;
}

/// Whether a point stays linear at these displacements: undamaged and below both elastic limits. A brittle direction may sit on
/// its limit, which the damaged branch then tells.
template <class Number, class Real>
FELDSPAR_LAW MaskOf<Real> is_linear(const BondLawOf<Number>& law, Real un, Real us, Real damage) {
    return (damage == Real{}) & (un <= law.normal.x0) & (NumberOf<Real>::absolute(us) <= law.shear.x0);
}

/// What the update of damaged points tells.
template <class Real>
struct BondUpdate {
    MaskOf<Real> broke{};  ///< now
    Real Fn_trial_N{};
};

/// The branch of update_bond for points that are damaged, or about to be. @param s  before; then after
template <class Number, class Real>
FELDSPAR_LAW BondUpdate<Real> update_damaged(const BondLawOf<Number>& law, Real area, Real dun, Real dus, BondStateOf<Real>& s) {
    const Real none{}, one = number<Real>(1.0);
    const Real kn = law.Kn_Pa_m * area, ks = law.Ks_Pa_m * area, inverse_area = 1.0 / area,
               inverse_ks = law.inverse_Ks * inverse_area;
    const Real normal_energy_before = normal_energy(law, inverse_area, s.Fn_N, s.un_m, s.damage);
    const Real Fn_before = s.Fn_N, Fs_before = s.Fs_N;
    const MaskOf<Real> broken_before = s.damage >= one, held_before = s.damage < one;
    const Real Fn_trial = s.Fn_N - kn * dun, Fs_trial = s.Fs_N - ks * dus;
    const Real pressed = larger(Fn_trial, none);
    s.un_m += dun;
    s.us_m += dus;

    Real measure = NumberOf<Real>::absolute(s.us_m);
    if (law.shear_beyond_friction) measure -= law.mu * pressed * inverse_ks;
    s.max_un_m = broken_before ? s.max_un_m : larger(s.max_un_m, s.un_m);
    s.max_us_m = broken_before ? s.max_us_m : larger(s.max_us_m, measure);
    Real damage = larger(s.damage, smaller(one, law.normal.damage(s.max_un_m) + law.shear.damage(s.max_us_m)));
    const Real tension_limit = (1.0 - damage) * law.sigma_nt_Pa * area;
    Real cohesion_limit = (1.0 - damage) * law.tau_Pa * area;
    if (maybe(law.normal.brittle)) damage = where(Fn_trial < -tension_limit, law.normal.brittle) ? one : damage;
    if (maybe(law.shear.brittle))
        damage = where(NumberOf<Real>::absolute(Fs_trial) > cohesion_limit + law.mu * pressed, law.shear.brittle) ? one : damage;
    s.damage = broken_before ? s.damage : damage;
    Real Fn = larger(Fn_trial, -tension_limit);
    if (law.secant_unloading) Fn = ((s.un_m > none) & (s.max_un_m > law.normal.x0)) ? -tension_limit * s.un_m / s.max_un_m : Fn;
    const MaskOf<Real> broken = s.damage >= one;
    s.Fn_N = broken ? (s.un_m < none ? -kn * s.un_m : none) : Fn;
    cohesion_limit = broken ? none : cohesion_limit;
    const Real friction_limit = law.mu * larger(s.Fn_N, none), limit = cohesion_limit + friction_limit;
    s.Fs_N = larger(smaller(Fs_trial, limit), -limit);

    // Work done on the point minus what it keeps (docs/theory/contacts.md): the normal part and the cohesive share of the
    // sliding are fracture, the frictional share is friction.
    const Real work_n = -0.5 * (Fn_before + s.Fn_N) * dun, work_s = -0.5 * (Fs_before + s.Fs_N) * dus;
    const Real dissipated_s = work_s + 0.5 * (Fs_before * Fs_before - s.Fs_N * s.Fs_N) * inverse_ks;
    const Real dissipated_n = work_n + normal_energy_before - normal_energy(law, inverse_area, s.Fn_N, s.un_m, s.damage);
    const Real share = limit > none ? friction_limit / limit : none;
    const Real friction_share = broken_before ? one : share;
    s.friction_J += friction_share * dissipated_s;
    s.fracture_J += dissipated_n + (1.0 - friction_share) * dissipated_s;
    return {where(broken, held_before), Fn_trial};
}

/// Elastic update with unlimited strength for intact points (the elastic start); broken points obey the real law.
/// @return true if the state is final, false if the real law has to be applied.
FELDSPAR_HD inline bool update_elastic(const BondLawOf<double>& law, double area_m2, double dun_m, double dus_m, BondState& s) {
    if (s.damage >= 1.0) return false;
    s.un_m += dun_m;
    s.us_m += dus_m;
    s.Fn_N = s.damage == 0.0 ? -(law.Kn_Pa_m * area_m2) * s.un_m : s.Fn_N - law.Kn_Pa_m * area_m2 * dun_m;
    s.Fs_N = s.damage == 0.0 ? -(law.Ks_Pa_m * area_m2) * s.us_m : s.Fs_N - law.Ks_Pa_m * area_m2 * dus_m;
    return true;
}

/// A bond that has just broken between bodies that did not touch each other, but were joined over a free gap: from now on they
/// push each other only when they meet. The energy of the compression that vanishes is booked as fracture.
FELDSPAR_HD inline void free_gap(const BondLawOf<double>& law, double area_m2, double gap_m, BondState& s) {
    const double before = elastic_energy(law, area_m2, s);
    s.un_m += gap_m;
    s.Fn_N = s.un_m < 0.0 ? -law.Kn_Pa_m * area_m2 * s.un_m : 0.0;
    const double limit = law.mu * s.Fn_N;
    s.Fs_N = larger(smaller(s.Fs_N, limit), -limit);
    s.fracture_J += before - elastic_energy(law, area_m2, s);
}

/// Advances a point by the increments of its gap and its shear displacement.
/// @param area_m2  A_J, the point's share of the contact area
/// @param dun_m    gap increment, opening positive
FELDSPAR_HD inline BondEvent update_bond(const BondLawOf<double>& law, double area_m2, double dun_m, double dus_m, BondState& s) {
    const double un = s.un_m + dun_m, us = s.us_m + dus_m;
    if (is_linear(law, un, us, s.damage)) {  // what most points are most of the time
        s.un_m = un;
        s.us_m = us;
        s.Fn_N = -(law.Kn_Pa_m * area_m2) * un;
        s.Fs_N = -(law.Ks_Pa_m * area_m2) * us;
        return BondEvent::none;
    }
    const BondUpdate<double> update = update_damaged(law, area_m2, dun_m, dus_m, s);
    return update.broke ? how_it_broke(update.Fn_trial_N, s.un_m) : BondEvent::none;
}

}  // namespace feldspar
