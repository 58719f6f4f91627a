// advance() with the kernels of fast/.
#pragma once

#include "feldspar/step/step.hpp"

namespace feldspar {

/// The settings as the kernels see them.
KernelStep kernel_step(const StepSettings& settings);

/// Writes how everything moves into the lines of packs that are sorted out.
void write_lines(Assembly& assembly, Team& team, const StepSettings& settings, const KernelArrays& arrays);

/// `count` steps from lines that are written.
void advance_packs(Assembly& assembly, Team& team, const StepSettings& settings, const KernelArrays& arrays, long long first_step,
                   int count, PlatenWork& work);

}  // namespace feldspar
