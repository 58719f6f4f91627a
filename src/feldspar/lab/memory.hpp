// How much memory a test needs while it runs.
#pragma once

#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Bytes of a specimen's arrays.
double memory_of(const Specimen& specimen);

/// Bytes that a test on this body takes at its peak, with the fields that it keeps for its snapshots and the writing of its
/// files. An estimate: docs/performance.md says how good it is.
double memory_of_run(const Specimen& specimen, const Assembly& assembly, const TestSpec& test);

}  // namespace feldspar
