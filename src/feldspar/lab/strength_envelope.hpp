// Mohr-Coulomb and Hoek-Brown through the strengths of one packing (docs/theory/properties.md).
#pragma once

#include <vector>

#include "feldspar/lab/properties.hpp"

namespace feldspar {

/// Uniaxial strength of Mohr and Coulomb's line, 2 c tan(45 deg + phi / 2) = 2 c sqrt(N).
double mohr_coulomb_UCS_Pa(double cohesion_Pa, double friction_angle_deg);

/// By how much a unit of confinement raises the strength on that line: N = tan^2(45 deg + phi / 2).
double mohr_coulomb_slope(double friction_angle_deg);

/// Fits both envelopes (P12), (P13); a value that the points do not determine is not-a-number. The caller fills in the
/// seed; the measured UCS is the strength at sigma_3 = 0, if there is one.
/// @param sigma3_Pa  confining stress of each test, compression positive
/// @param sigma1_Pa  total axial strength of each test, in the same order
/// @param DTS_Pa     direct tensile strengths (positive), through which Hoek-Brown's parabola is to go too: sigma_3 = -DTS,
/// sigma_1 = 0
EnvelopeFit fit_envelopes(std::vector<double> sigma3_Pa, std::vector<double> sigma1_Pa, const std::vector<double>& DTS_Pa = {});

}  // namespace feldspar
