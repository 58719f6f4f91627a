// A bent beam: its measures, and the closed forms that turn loads into stresses and toughness (docs/theory/properties.md,
// (P36)-(P40)).
#pragma once

#include "feldspar/methods/test_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// A beam that lies along x: on two rollers below, loaded by one above in the middle.
struct Beam {
    double height_m = 0.0;       ///< h
    double span_m = 0.0;         ///< S, between the supports
    double thickness_m = 0.0;    ///< t
    double notch_m = 0.0;        ///< a, from below in the middle of the span; 0: none
    double notch_width_m = 0.0;  ///< at its mouth
    bool otherwise_cut = false;  ///< holes, or notches elsewhere: the closed forms do not hold
    double middle_m = 0.0;       ///< x of the middle of the span
    double bottom_m = 0.0;       ///< y of the lower side

    double top_m() const { return bottom_m + height_m; }
    double ligament_m() const { return height_m - notch_m; }
    bool notched() const { return notch_m > 0.0; }
};

/// The beam that a specimen is in a test. @throws InputError  if it is none: no flat lower or upper side, a span that is longer
/// than the beam, a height that is not below the span, or a notch that leaves no ligament or does not lie in the middle of the
/// span
Beam beam_of(const Outline& outline, double thickness_m, const TestSpec& test);

/// What is cut out of a specimen that is bent.
struct NotchFromBelow {
    double depth_m = 0.0;  ///< 0: none
    double width_m = 0.0;
    bool otherwise_cut = false;  ///< holes, or notches that do not rise upright from the lower side in the middle
};

/// Looks for a notch that rises from the lower side at x = `middle_m`, y = `bottom_m`. @throws InputError  if it goes through to
/// `height_m` above
NotchFromBelow notch_from_below(const Outline& outline, double middle_m, double bottom_m, double height_m);

/// Largest stress of a plain beam under a point load over 3PS/(2 t h^2) (P36): the load's own stresses take some of it away.
/// @param height_over_span  h/S, at most 1/3
double flexural_factor(double height_over_span);

/// Deflection of a plain beam's axis under the load, against the axis above the supports, times E t / P (P37). Plane stress.
double deflection_factor(const Beam& beam, double nu);

/// K_I of an edge notch over P S / (t h^1.5) (P38). @param x  a/h, 0 to 1  @param height_over_span  h/S, at most 0.4
double notch_factor(double x, double height_over_span);

/// Opening of the notch's mouth times E' t / P (P39), for a span of 4 h. @param x  a/h, 0 to 1
double mouth_factor(double x);

/// The specimen of a job with a beam, for `feldspar new`.
inline constexpr const char* beam_width_line = R"(width = "220 mm"                    # along the beam)";
inline constexpr const char* beam_height_line = R"(height = "50 mm"                    # the load acts downwards
# notches = [{ from = ["110 mm", "0 mm"], to = ["110 mm", "15 mm"], width = "1 mm" }]   # sawn slits; "0 mm": a cut)";

/// The ratio S/h for which mouth_factor() holds, and by how much a beam's may differ.
inline constexpr double mouth_span = 4.0, mouth_span_tolerance = 0.02;

}  // namespace feldspar
