// How a plate with a round hole fails (docs/theory/properties.md, (P49)-(P51)): stresses at the edge of the hole, first cracks,
// breakouts.
#pragma once

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// @param peak  from find_peak() of the same result
HoleProperties hole_failure(const TestResult& result, const Peak& peak);

}  // namespace feldspar
