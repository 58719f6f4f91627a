// Why nothing broke, or too early: what a user should know of a test that ended without a strength, or with an odd one.
#pragma once

#include <string>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// The length over which a contact softens in tension, E Gfn / sigma_nt^2, over the mean grain diameter; of rigid grains Kn d
/// stands for E. 0 of a brittle law.
double softening_over_grain(const TestResult& result);

/// Above so many grain diameters a contact gives way without breaking before the specimen has yielded elsewhere; rocks have 0.3
/// to 20.
inline constexpr double ductile_over_grain = 50.0;

/// Sentences, empty for an ordinary test: nothing broke, or the strength was not reached (and why: what ended the test, the
/// contact nearest to failure, the strength that the scaling rules expect), contacts that cannot break brittly, a strength far
/// below the expected one.
/// @param properties  measured of this result: strength and whether it was reached. Of `result` it reads record, cracks,
/// materials, stop_reason and nearest
std::vector<std::string> why_odd(const TestResult& result, const TestProperties& properties);

}  // namespace feldspar
