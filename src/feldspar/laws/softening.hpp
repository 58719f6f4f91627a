// The softening envelope of a contact point in one direction (paper: figure 3), per area.
//
//     strength F, elastic limit x0 = F / k, x_fl = 2 Gf / F, L = x_fl - x0; the break point has the strength 0.25 F.
//     bilinear (energy-conserving):  x_y = x0 + 0.375 L,  x_f = x0 + 2.5 L          area under the curve = Gf exactly
//     bilinear-literal (figure 3):   x_y = x0 + 0.75 L,   x_f = x_y + 5 (x_fl - x_y)  area = Gf (1 + 0.25 (1 - x0 / x_fl))
//     linear:                        x_f = x_fl                                      area = Gf
// If L <= 0 there is nothing to soften: the direction is brittle. Derivation of the areas: docs/theory/contacts.md.
#pragma once

#include "feldspar/laws/number.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// @tparam Number  double: of one law; a vector of doubles: of a law a lane
template <class Number>
struct SofteningEnvelopeOf {
    Number x0{};               ///< m, end of the elastic branch
    Number x_y{};              ///< m, break point
    Number x_f{};              ///< m, no strength left
    Number first_slope{};      ///< 1/m, of the damage up to the break point; 0 in a brittle direction
    Number second_slope{};     ///< 1/m, beyond it
    MaskOf<Number> brittle{};  ///< breaks when the trial force passes its limit, and knows no softening

    /// @param x_fl  2 Gf / F; not beyond x0: brittle
    FELDSPAR_LAW static SofteningEnvelopeOf from(ContactLaw law, Number x0, Number x_fl) {
        SofteningEnvelopeOf e;
        const Number none{}, L = x_fl - x0;
        e.x0 = x0;
        e.brittle = law == ContactLaw::brittle ? x0 == x0 : L <= none;
        const Number x_y = law == ContactLaw::bilinear ? x0 + 0.375 * L : x0 + 0.75 * L;  // linear: on the straight line
        const Number x_f = law == ContactLaw::bilinear ? x0 + 2.5 * L
                           : law == ContactLaw::linear ? x_fl
                                                       : x_y + 5.0 * (x_fl - x_y);
        e.x_y = e.brittle ? x0 : x_y;
        e.x_f = e.brittle ? x0 : x_f;
        e.first_slope = e.x_y > x0 ? 0.75 / (e.x_y - x0) : none;
        e.second_slope = e.x_y > x0 ? 0.25 / (e.x_f - e.x_y) : none;
        return e;
    }

    /// Damage of this direction, 1 - f(x) / F, for the largest displacement x so far; 0 for a brittle direction.
    template <class Real>
    FELDSPAR_LAW Real damage(Real x) const {
        const Real none{}, one = number<Real>(1.0);
        if (!maybe(first_slope != Number{})) return none;
        const Real softened = x <= x_y - none ? first_slope * (x - x0) : 1.0 - second_slope * (x_f - x);
        const Real damage = x <= x0 - none ? none : x < x_f - none ? softened : one;
        return first_slope == Number{} ? none : damage;
    }
};

/// Of one law.
struct SofteningEnvelope : SofteningEnvelopeOf<double> {
    /// @param strength_Pa     F per area
    /// @param stiffness_Pa_m  k per area
    /// @param energy_J_m2     Gf
    static SofteningEnvelope make(ContactLaw law, double strength_Pa, double stiffness_Pa_m, double energy_J_m2) {
        return {from(law, strength_Pa / stiffness_Pa_m, 2.0 * energy_J_m2 / strength_Pa)};
    }
};

}  // namespace feldspar
