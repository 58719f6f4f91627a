// How fast the cores are right now. Multiply-adds in registers depend on nothing but the core and who else uses it; reading from
// the shared cache depends on who else uses that.
#pragma once

#include "benchmarks/reading.hpp"
#include "feldspar/base/parallel.hpp"

namespace feldspar::benchmarks {

/// Widest vectors of this machine that the calibration can use, in bits: 512, 256, or 128 (also where there is no fused
/// multiply-add and the compiler's own code runs).
int vector_bits();

/// GFLOP/s in double precision of the calling thread, over about so many seconds of wall time.
double multiply_add_rate(double seconds);

/// GB/s of the calling thread that reads 8 MiB of its own again and again, over about so many seconds of processor time
/// (that a core was lost shows in the other rate): more than a core's own caches hold, so that what it read before is gone from
/// these.
double read_rate(double seconds);

/// Both on every thread of the team at once, each over half of the time: the rates of the slowest.
Rates slowest_rates(Team& team, double seconds);

}  // namespace feldspar::benchmarks
