// Rules between contact parameters and the numbers of a laboratory, measured with this program, and their inverse: first contact
// parameters.
//
// Source: the experiment studies/first-parameters/design.toml (89 rocks on specimens of 40 x 80 mm and discs of 40 mm, flexible
// grains of 2 to 4 mm, bilinear softening), fitted by tests/validation/first_parameters.py. Table, fits and their errors on
// packings that were left out: docs/validation/first-parameters.md. They are made to begin a calibration, not to replace a test.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "feldspar/model/spec.hpp"

namespace feldspar {

/// What a laboratory reads off a rock. Not-a-number where nothing is known.
struct RockNumbers {
    double E_Pa = 0.0;  ///< before damage
    double nu = 0.0;
    double UCS_Pa = 0.0;
    double DTS_Pa = 0.0;
    double BTS_Pa = 0.0;
    double friction_angle_deg = 0.0;  ///< of the line through the UCS and the strength at a pressure of about a tenth of it
};

/// Relative errors of the rules: root mean square on packings that were left out of the fit.
struct RuleErrors {
    double UCS = 0.0, DTS = 0.0, BTS = 0.0;
    double friction_angle_deg = 0.0;
};
extern const RuleErrors rule_errors;

/// What the rules expect of such a rock. A parameter beyond what the experiment has counts as at its end.
/// @param grain            E > 0; flexible grains
/// @param contact          bilinear; strengths, stiffnesses and fracture energies > 0
/// @param grain_m          mean diameter of the grains, > 0
/// @param inverse_modulus  1 / Weibull modulus of strengths that scatter, cut off at a tenth of the mean; 0: an even rock
RockNumbers expected_rock(const GrainMaterial& grain, const ContactMaterial& contact, double grain_m,
                          double inverse_modulus = 0.0);

/// What a user knows of his rock; at least a strength.
struct RockTargets {
    std::optional<double> E_Pa, nu, UCS_Pa, DTS_Pa, BTS_Pa, cohesion_Pa, friction_angle_deg;
};

/// Parameters to begin with, and what the rules expect of them.
struct FirstParameters {
    GrainMaterial grain;
    ContactMaterial contact;
    double inverse_modulus = 0.0;  ///< as of expected_rock()
    RockNumbers expected;
    double wanted_ratio = 0.0;  ///< UCS over BTS, else over DTS; not-a-number where only one of them is known
    double lowest_ratio = 0.0;  ///< that the rules reach within the ranges below, with the friction that is wanted
    double highest_ratio = 0.0;
    bool of_DTS = false;               ///< these ratios are UCS/DTS
    bool friction_reached = true;      ///< the friction angle that is wanted, within 3 degrees
    std::vector<std::string> assumed;  ///< what was not given and is assumed, in sentences

    /// Within what the rules reach, and their error of a tensile strength beyond it: first guesses there came as near as others
    /// (docs/validation/first-parameters.md).
    bool ratio_reached() const {
        return !((1.0 + rule_errors.BTS) * wanted_ratio < lowest_ratio) &&
               !(wanted_ratio > (1.0 + rule_errors.BTS) * highest_ratio);
    }
};

/// Inverts the rules. Kn d / E of the grains is 20, eta 0.28 as in the paper's Table 1; mu follows from the friction angle, else
/// it is chosen; tau/sigma_nt, mu and the brittleness E Gfn / (sigma_nt^2 d) move together from their middle values until UCS
/// over tensile strength is met; sigma_nt then meets the UCS. A ratio that is out of reach: the nearest one is taken, and UCS is
/// met.
/// @param inverse_modulus  of a rock whose strengths scatter; 0: even
/// @throws std::invalid_argument without any strength
FirstParameters first_parameters(const RockTargets& targets, double grain_m, double inverse_modulus = 0.0);

/// The least scatter, as an inverse Weibull modulus from 0 to 1/1.3, with which the rules reach the ratio that is wanted; none if
/// they do not.
std::optional<double> scatter_for(const RockTargets& targets, double grain_m);

}  // namespace feldspar
