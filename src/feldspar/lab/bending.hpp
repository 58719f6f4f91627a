// What a bent beam or half disc shows: flexural strength and modulus, or toughness and work of fracture (P36)-(P40), (P47), (P48), docs/theory/properties.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "feldspar/lab/loading_curve.hpp"
#include "feldspar/lab/result.hpp"

namespace feldspar {

/// @param peak  from find_peak() of the same result
BendingProperties bending(const TestResult& result, const Peak& peak);

/// Length (m) of the shortest chain of cracks from a notch's tip to the end of a crack that lies highest; gaps of up to a quarter of a grain are bridged.
/// 0 without cracks at the tip. Costs time with the square of the number of cracks. @param reach_m  how near to the tip a chain may begin
double chain_of_cracks_m(std::span<const Crack> cracks, Vec2 tip, double grain_m, double reach_m);

/// Of a notched half disc. @param peak  from find_peak() of the same result
BendingProperties half_disc_bending(const TestResult& result, const Peak& peak);

/// Sentences on a half disc that is none of ISRM's, or too small for its softening zone (P48). @param p  from half_disc_bending()
std::vector<std::string> half_disc_remarks(const TestResult& result, const BendingProperties& p);

}  // namespace feldspar
