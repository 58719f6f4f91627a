// The softening envelope of a contact point in one direction (paper: figure 3), per area.
//
//     strength F, elastic limit x0 = F / k, x_fl = 2 Gf / F, L = x_fl - x0; the break point has the strength 0.25 F.
//     bilinear (energy-conserving):  x_y = x0 + 0.375 L,  x_f = x0 + 2.5 L          area under the curve = Gf exactly
//     bilinear-literal (figure 3):   x_y = x0 + 0.75 L,   x_f = x_y + 5 (x_fl - x_y)  area = Gf (1 + 0.25 (1 - x0 / x_fl))
//     linear:                        x_f = x_fl                                      area = Gf
// If L <= 0 there is nothing to soften: the direction is brittle. Derivation of the areas: docs/theory/contacts.md.
#pragma once

#include "feldspar/model/spec.hpp"

namespace feldspar {

struct SofteningEnvelope {
    double x0 = 0.0;       ///< m, end of the elastic branch
    double x_y = 0.0;      ///< m, break point
    double x_f = 0.0;      ///< m, no strength left
    bool brittle = false;  ///< breaks when the trial force passes its limit, and knows no softening

    /// @param strength_Pa     F per area
    /// @param stiffness_Pa_m  k per area
    /// @param energy_J_m2     Gf
    static SofteningEnvelope make(ContactLaw law, double strength_Pa, double stiffness_Pa_m, double energy_J_m2) {
        SofteningEnvelope e;
        e.x0 = strength_Pa / stiffness_Pa_m;
        const double x_fl = 2.0 * energy_J_m2 / strength_Pa;
        const double L = x_fl - e.x0;
        e.brittle = law == ContactLaw::brittle || !(L > 0.0);
        if (e.brittle) {
            e.x_y = e.x_f = e.x0;
        } else if (law == ContactLaw::bilinear) {
            e.x_y = e.x0 + 0.375 * L;
            e.x_f = e.x0 + 2.5 * L;
        } else if (law == ContactLaw::bilinear_literal) {
            e.x_y = e.x0 + 0.75 * L;
            e.x_f = e.x_y + 5.0 * (x_fl - e.x_y);
        } else {
            e.x_y = e.x0 + 0.75 * L;   // on the straight line
            e.x_f = x_fl;
        }
        return e;
    }

    /// Damage of this direction, 1 - f(x) / F, for the largest displacement x so far; 0 for a brittle direction.
    double damage(double x) const {
        if (x <= x0 || brittle) return 0.0;
        if (x <= x_y) return 0.75 * (x - x0) / (x_y - x0);
        if (x < x_f) return 1.0 - 0.25 * (x_f - x) / (x_f - x_y);
        return 1.0;
    }
};

}  // namespace feldspar
