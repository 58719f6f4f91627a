// advance() with the kernels of fast/.
#pragma once

#include "feldspar/step/step.hpp"

namespace feldspar {

/// The settings as the kernels see them.
KernelStep kernel_step(const StepSettings& settings);

/// @param settings  names the kernels
void advance_packs(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count, PlatenWork& work);

}  // namespace feldspar
