// The branch behind the peak: post-peak modulus, brittleness, where the energy went (P32)-(P34), docs/theory/properties.md.
#pragma once

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Whether a servo led the platens behind the peak: elsewhere the branch is dynamic, whatever the rock is.
bool branch_is_followed(const TestResult& result);

/// @param curve  up to the peak, from loading_curve() of the same result
/// @param E_Pa   modulus with which the specimen unloads: the tangent one
PostPeak post_peak(const TestResult& result, const Peak& peak, const LoadingCurve& curve, double E_Pa);

}  // namespace feldspar
