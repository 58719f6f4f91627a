// Readings as they were taken, and what they mean: the best undisturbed block, the median, whether to trust them.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace feldspar::benchmarks {

/// How fast the cores were at a moment: of those that took part, the slowest.
struct Rates {
    double multiply_add = 0.0;  ///< GFLOP/s a core
    double memory = 0.0;        ///< GB/s a core, read from 8 MiB that only the shared cache holds
};

/// A number of steps that were timed in one go, between two calibrations.
struct Block {
    int steps = 0;
    double wall_s = 0.0;    ///< of all steps together
    double cpu_s = 0.0;     ///< processor time of the calling thread
    double waited_s = 0.0;  ///< that threads were ready and had no core, all of them together
    Rates before, after;    ///< the calibrations on both sides
};

/// What a step has to do, for times per piece.
struct Counts {
    long long grains = 0;
    long long bodies = 0;  ///< grains, or their inner particles, and plates
    long long nodes = 0;
    long long triangles = 0;
    long long contacts = 0;
    long long points = 0;       ///< contact points
    double memory_bytes = 0.0;  ///< of the assembly
    bool operator==(const Counts&) const = default;
};

/// A case as it was measured.
struct Reading {
    std::string name;
    std::string stage;
    int threads = 1;
    Counts counts;
    std::vector<Block> blocks;
};

/// When a block counts as undisturbed, and how many must.
struct QuietRule {
    double share =
        0.9;  ///< of the best rate of multiply-adds seen in the run; of the wall time in which no thread had to wait for a core
    int blocks = 10;  ///< undisturbed blocks that a reading needs
};

/// Best rate of multiply-adds seen in a run by number of threads, GFLOP/s a core: with more cores at work each may be slower.
using BestCalibrations = std::map<int, double>;

/// Both rates of multiply-adds near the best, and no core lost meanwhile to somebody else: that is what the system says of
/// waiting threads, and on one thread its processor time.
bool is_quiet(const Block& block, int threads, double best_calibration, const QuietRule& rule);

/// A reading in a few numbers, seconds a step. Taken over the undisturbed blocks; over all if there is none.
struct Summary {
    double best_s = 0.0;
    double median_s = 0.0;
    double cpu_s = 0.0;        ///< least processor time of the calling thread
    double memory_rate = 0.0;  ///< GB/s a core: median of what the blocks' calibrations saw
    int quiet_blocks = 0;
    bool disturbed = true;  ///< fewer undisturbed blocks than the rule asks
};

/// A reading without blocks has not-a-number for its times.
Summary summarise(const Reading& reading, const BestCalibrations& best, const QuietRule& rule);

/// Of the values, not-a-number if there is none; an even number of them has the mean of the middle two.
double median(std::vector<double> values);

}  // namespace feldspar::benchmarks
