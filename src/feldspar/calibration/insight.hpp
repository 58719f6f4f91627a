// What a calibration has learned besides its answer: what the answer hinges on, what cannot be told apart, what cannot be had
// together.
#pragma once

#include <vector>

#include "feldspar/calibration/calibrate.hpp"

namespace feldspar {

/// Mean of a target on fresh packings and its 95 % interval. Of a target that follows from several strengths (a ratio, an
/// envelope) by the jackknife: leaving out one packing after the other.
/// @param seen  [quantity][packing]; not-a-number for a test that is left out: the other tests of that packing count
MeanInterval confirmed_interval(const Target& target, const std::vector<Observable>& quantities,
                                const std::vector<std::vector<double>>& seen);

/// Fills in sensitivities, ranges and findings for the unknowns of this part.
/// @param part  which unknowns the learner's parameters are; @param best  of all unknowns, 0 ... 1
void look_into(const Learner& learner, const Calibration& calibration, const std::vector<std::size_t>& part,
               const std::vector<double>& best, CalibrationResult& result);

}  // namespace feldspar
