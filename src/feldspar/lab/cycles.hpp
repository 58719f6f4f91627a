// Cycles of loading and unloading: moduli, permanent strains and damage (docs/theory/properties.md, (P52)-(P54)).
#pragma once

#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// The cycles of a test with stages, in order: a stage that loads and the unloading behind it, with all that lies between. The
/// last may have no unloading. Empty for a test that never unloads.
std::vector<CycleProperties> cycles_of(const TestResult& result);

}  // namespace feldspar
