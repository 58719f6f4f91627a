// Taking a reading: blocks of steps between calibrations, until enough of them were undisturbed.
#pragma once

#include <functional>
#include <vector>

#include "benchmarks/reading.hpp"

namespace feldspar::benchmarks {

struct MeasureSettings {
    QuietRule quiet;
    int most_blocks = 100;  ///< then the reading stays as it is, and is marked
    double block_s = 0.01;  ///< length of a block, about; at least one step. Short, so that it fits between disturbances
    double calibration_s = 0.002;
};

/// How long the threads of this process have been ready so far and had no core, all of them together; 0 where the system does not
/// say.
double waited_seconds();

/// Measures `run(steps)` after some steps that only warm up and tell how many make a block.
/// @param calibrate         the rates now, of the slowest core that takes part
/// @param waited            seconds so far that threads had no core: waited_seconds, except in tests
/// @param threads           that `run` uses
/// @param best_rate         of multiply-adds: the best seen so far with so many threads; grows when a better one is seen
std::vector<Block> measure(const std::function<void(int)>& run, const std::function<Rates()>& calibrate,
                           const std::function<double()>& waited, int threads, const MeasureSettings& settings,
                           double& best_rate);

}  // namespace feldspar::benchmarks
