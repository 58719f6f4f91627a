// What a rock with minerals, scatter or joints came to on a specimen, for summary.json and the report; and its acoustic emission.
#pragma once

#include <nlohmann/json.hpp>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Whether the rock differs from place to place, or has crystals of several grains.
bool has_texture(const TestResult& result);

/// minerals, pairs, draws, initial cracks, joints: what the rock has of them; an empty object of an even rock.
nlohmann::ordered_json texture_json(const TestResult& result);

/// Acoustic emission: count, b-value, dimension, shares; counts for other radii. Null without cracks.
nlohmann::ordered_json acoustic_emission_json(const TestResult& result);

}  // namespace feldspar
