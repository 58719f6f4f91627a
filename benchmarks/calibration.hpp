// How fast the cores are right now: multiply-adds in registers, which depend on nothing but the core and who else uses it.
#pragma once

#include "feldspar/base/parallel.hpp"

namespace feldspar::benchmarks {

/// Widest vectors of this machine that the calibration can use, in bits: 512, 256, or 128 (also where there is no fused
/// multiply-add and the compiler's own code runs).
int vector_bits();

/// GFLOP/s in double precision of the calling thread, over about so many seconds of wall time.
double multiply_add_rate(double seconds);

/// The same on every thread of the team at once: the rate of the slowest.
double slowest_rate(Team& team, double seconds);

}  // namespace feldspar::benchmarks
