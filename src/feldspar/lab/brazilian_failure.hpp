// Where and how a Brazilian disc failed, beside its strength (P27)-(P29), docs/theory/properties.md.
#pragma once

#include <string>

#include "feldspar/lab/loading_curve.hpp"

namespace feldspar {

/// A test is valid only if the crack that split the disc began nearer to the centre than this share of the radius: there the tension under
/// an arc of 10 degrees is still 0.93 of that in the centre; at 0.7 it is 0.83, and beyond 0.85 a plate's own stress decides.
inline constexpr double central_part = 0.6;

/// @param peak  from find_peak() of the same result
BrazilianFailure brazilian_failure(const TestResult& result, const Peak& peak);

/// A sentence for the verdict, beginning with a space, where the strength is not that of a valid test; else empty.
std::string start_remark(const TestResult& result, const Peak& peak);

}  // namespace feldspar
