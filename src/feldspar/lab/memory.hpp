// How much memory a test needs while it runs.
#pragma once

#include "feldspar/lab/run_test.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// Bytes of a specimen's arrays.
double memory_of(const Specimen& specimen);

/// Bytes that a test on this body takes at its peak, with the states to which it may go back, its record, the fields that it
/// keeps for its snapshots and the writing of its files. docs/performance.md says how good it is.
/// @param steps  of loading: the record grows with them
Foreseen memory_of_run(const TestSetup& setup, const Assembly& assembly, const Foreseen& steps);

}  // namespace feldspar
