// What the outline of a specimen means for its numbers: the section that stresses are taken over, whether the strain is uniform,
// and whether a column of this shape would bend aside before it breaks.
#pragma once

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// By how much the width of a specimen may vary along the height, as a share of its narrowest section, before the strain no
/// longer counts as uniform: E and nu would be wrong by up to as much.
inline constexpr double uniform_width = 0.02;

/// The axial stress at which a column bends aside (Pa): Euler's load of two platens that stay parallel and may slide along each
/// other, pi^2 E w^2 / (12 L^2).
double euler_stress_Pa(double E_Pa, double width_m, double height_m);

/// Height over width from which on a column of this modulus and strength bends before it breaks.
double slenderest(double E_Pa, double strength_Pa);

/// Notes the section in the properties, and takes out what a specimen of varying width does not define: moduli from the platens,
/// and what the gauge reads where the width varies in the gauge's window. Says so in the remarks.
void note_section(const TestResult& result, TestProperties& properties);

/// Grade C, with a sentence, where the measured strength (biaxial: sigma_1 - sigma_3) is above Euler's stress for the measured
/// modulus: the test loads straight on what would have bent.
void look_at_buckling(const TestResult& result, QuasiStaticEvidence& evidence);

}  // namespace feldspar
