// A notched half disc that is bent: its measures, and what turns its load into a toughness (docs/theory/properties.md, (P47)).
#pragma once

#include "feldspar/methods/test_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// A half disc that stands with its flat on two rollers and is loaded by a third on the top of its arc.
struct HalfDisc {
    double radius_m = 0.0;     ///< R
    double span_m = 0.0;       ///< s, between the supports
    double thickness_m = 0.0;  ///< t
    double notch_m = 0.0;      ///< a, from the middle of the flat upwards
    double notch_width_m = 0.0;
    Vec2 middle{};       ///< of the flat, m
    double top_m = 0.0;  ///< y of the top of the arc, which is a polygon

    double beta() const { return notch_m / radius_m; }
    double q() const { return 0.5 * span_m / radius_m; }
    double ligament_m() const { return radius_m - notch_m; }
};

/// Ranges of ISRM (2014).
inline constexpr double least_beta = 0.4, most_beta = 0.6, least_q = 0.5, most_q = 0.8;
inline constexpr double least_half_disc_m = 0.076, least_grains_across = 10.0;  ///< diameter: the larger of both

/// The half disc that a specimen is in a test; its span is 1.2 R unless the test gives one.
/// @throws InputError  if it is none, has no notch or another one than from the middle of its flat upwards, or the supports lie
/// outside
HalfDisc half_disc_of(const Outline& outline, double thickness_m, const TestSpec& test);

/// Y' of ISRM's fit: K_I = Y' P sqrt(pi a) / (2 R t) (P47). @param beta  a/R, 0.4 to 0.6  @param q  s/(2R), 0.5 to 0.8
double half_disc_factor(double beta, double q);

}  // namespace feldspar
