// Where and how a Brazilian disc failed, beside its strength (P27)-(P29), docs/theory/properties.md.
#pragma once

#include <string>
#include <vector>

#include "feldspar/lab/loading_curve.hpp"

namespace feldspar {

/// A test is valid only if the crack that split the disc began nearer to the centre than this share of the radius: there the
/// tension under an arc of 10 degrees is still 0.93 of that in the centre; at 0.7 it is 0.83, and beyond 0.85 a plate's own
/// stress decides.
inline constexpr double central_part = 0.6;

/// @param peak  from find_peak() of the same result
BrazilianFailure brazilian_failure(const TestResult& result, const Peak& peak);

/// Tension in the centre of a whole elastic disc over 2P / (pi D t), if the load is a uniform pressure on an arc at either end
/// (P35): 1 for a point, 0.96 for 20 degrees. What touches presses most in the middle of its arc, so that the true one is nearer
/// to 1. @param arc_deg  of contact, 0 to 180
double tension_under_arcs(double arc_deg);

/// A moment of a Brazilian test that a reader looks for on its curve, and on its picture if it is a crack.
struct BrazilianMark {
    std::string name;  ///< "first crack", "first dip", "start of the splitting crack", "strength", "largest stress"
    double axial_strain = 0.0;
    double stress_Pa = 0.0;
    int crack = -1;  ///< into TestResult::cracks, if it is one
};

/// In the order of the test's time. The largest stress only where it is not the strength; without cracks or a loaded row, fewer.
std::vector<BrazilianMark> brazilian_marks(const TestResult& result);

/// "yes", or "no" and why.
std::string validity_in_words(const BrazilianFailure& failure);

/// A sentence for the verdict, beginning with a space, where the strength is not that of a valid test; else empty.
std::string start_remark(const TestResult& result, const Peak& peak);

}  // namespace feldspar
