#include "benchmarks/measure.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace feldspar::benchmarks {
namespace {

double wall_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Of the calling thread: its steps alone, whatever the process does besides.
double processor_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Block timed(const std::function<void(int)>& run, const std::function<double()>& waited, int steps) {
    Block block;
    block.steps = steps;
    const double waited_before = waited(), wall = wall_seconds(), cpu = processor_seconds();
    run(steps);
    block.cpu_s = processor_seconds() - cpu;
    block.wall_s = wall_seconds() - wall;
    block.waited_s = waited() - waited_before;
    return block;
}

// Doubles the steps until they are long enough to be judged by. That fills the caches besides.
int steps_in_block(const std::function<void(int)>& run, const std::function<double()>& waited, double block_s) {
    constexpr int kMost = 1 << 20;
    run(1);
    int steps = 1;
    double wall_s = timed(run, waited, steps).wall_s;
    while (wall_s < 0.5 * block_s && steps < kMost) wall_s = timed(run, waited, steps *= 2).wall_s;
    return static_cast<int>(std::clamp(block_s / wall_s * steps, 1.0, 1.0 * kMost));
}

}  // namespace

std::vector<Block> measure(const std::function<void(int)>& run, const std::function<Rates()>& calibrate,
                           const std::function<double()>& waited, int threads, const MeasureSettings& settings,
                           double& best_rate) {
    const int steps = steps_in_block(run, waited, settings.block_s);
    const int warm_up =
        steps / 20;  // brings the caches back that the calibration has used; nothing where a step is as long as a block
    const auto calibration = [&] {
        const Rates rates = calibrate();
        best_rate = std::max(best_rate, rates.multiply_add);
        return rates;
    };
    const auto quiet_blocks = [&](const std::vector<Block>& blocks) {
        return std::count_if(blocks.begin(), blocks.end(),
                             [&](const Block& block) { return is_quiet(block, threads, best_rate, settings.quiet); });
    };
    std::vector<Block> blocks;
    Rates before = calibration();
    // Counted anew each time, because a better calibration may come late and show that earlier blocks were disturbed.
    while (static_cast<int>(blocks.size()) < settings.most_blocks && quiet_blocks(blocks) < settings.quiet.blocks) {
        if (warm_up > 0) run(warm_up);
        Block block = timed(run, waited, steps);
        block.before = before;
        block.after = before = calibration();
        blocks.push_back(block);
    }
    return blocks;
}

}  // namespace feldspar::benchmarks
