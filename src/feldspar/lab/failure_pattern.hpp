// How a specimen failed, in a few numbers: which cracks, in which direction, how concentrated, how abruptly (P15)-(P17), docs/theory/properties.md.
#pragma once

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Cracks count by their length, so that models with one and with three points on a grain edge compare. Of all cracks of the record;
/// not-a-number without any.
struct FailurePattern {
    double tensile_share;        ///< length of tensile cracks over that of all, 0 ... 1
    double crack_angle_deg;      ///< mean direction (doubled angles), from the loading axis, 0 ... 90
    double crack_alignment;      ///< 0: every direction alike, 1: all parallel; length of the mean of doubled angles
    double crack_localisation;   ///< share of the crack length in the most cracked tenth of the specimen, by squares of a tenth of its width
    double post_peak_strain;     ///< axial strain from the peak until 80 % of it, or the record's end, over the strain at the peak: 0 drops at once
};

FailurePattern failure_pattern(const TestResult& result);

}  // namespace feldspar
