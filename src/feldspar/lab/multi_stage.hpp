// One specimen loaded under rising pressures: a strength envelope from it (docs/theory/properties.md, (P55), (P56)).
#pragma once

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// @param peak  from find_peak() of the same result
MultiStageProperties multi_stage(const TestResult& result, const Peak& peak);

}  // namespace feldspar
