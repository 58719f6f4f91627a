// Which kernels a program uses, where the choice of best_kernels() is not the wanted one.
#pragma once

#include "feldspar/fast/kernels.hpp"

namespace feldspar {

/// From now on best_kernels() gives these, which this processor must support (is_supported()). Not while a test runs: one that
/// begins with some kernels and goes on with others is neither's. For tests that need the bits of one instruction set on any
/// processor.
void use_kernels(const Kernels& kernels);

}  // namespace feldspar
