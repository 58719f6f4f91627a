// How many steps a test will take, before it is run. Strengths come from a rate that follows the specimen, so the number is known
// as a range only (docs/performance.md has the measured numbers).
#pragma once

#include "feldspar/lab/experiment.hpp"

namespace feldspar {

/// Loading steps between two rows of the history.
inline int steps_per_row(const NumericsSpec& numerics) { return numerics.kind == NumericsKind::adaptive ? 10 : 50; }

/// Loading steps of a test whose step has been chosen (choose_step()), within numerics.maximum_steps.
Foreseen foreseen_steps(const Experiment& experiment);

}  // namespace feldspar
