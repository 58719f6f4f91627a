// How a specimen failed, in a few numbers: which cracks, in which direction, how concentrated, how abruptly (P15)-(P17), (P72),
// docs/theory/properties.md.
#pragma once

#include <string>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Cracks count by their length, so that models with one and with three points on a grain edge compare. Of all cracks of the
/// record; not-a-number without any.
struct FailurePattern {
    double tensile_share;       ///< length of tensile cracks over that of all, 0 ... 1
    double crack_angle_deg;     ///< mean direction (doubled angles), from the loading axis, 0 ... 90
    double crack_alignment;     ///< 0: every direction alike, 1: all parallel; length of the mean of doubled angles
    double crack_localisation;  ///< share of the crack length in the most cracked tenth of the specimen, by squares of a tenth of
                                ///< its width
    double band_angle_deg;      ///< long axis of the most cracked tenth, from the loading axis, 0 ... 90 (P72)
    double band_elongation;     ///< how many times as long as wide it is, >= 1
    double post_peak_strain;  ///< axial strain from the peak until 80 % of it, or the record's end, over the strain at the peak:
                              ///< 0 drops at once
};

FailurePattern failure_pattern(const TestResult& result);

/// The form of a failure in compression, as a rock laboratory names it, with the numbers that it is read from
/// (docs/theory/properties.md, failure patterns).
struct FailureMode {
    std::string name;   ///< "axial splitting", "shear band", "crushing", "axial cracks without one form"; empty of other tests,
                        ///< and of one that did not fail
    std::string words;  ///< the numbers, as a sentence
};

FailureMode failure_mode(const TestResult& result);

}  // namespace feldspar
