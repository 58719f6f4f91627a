// What a bent beam shows: flexural strength and modulus, or toughness and work of fracture (P36)-(P40), docs/theory/properties.md.
#pragma once

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/result.hpp"

namespace feldspar {

/// @param peak  from find_peak() of the same result
BendingProperties bending(const TestResult& result, const Peak& peak);

}  // namespace feldspar
