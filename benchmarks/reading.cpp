#include "benchmarks/reading.hpp"

#include <algorithm>
#include <cmath>

namespace feldspar::benchmarks {

bool is_quiet(const Block& block, int threads, double best_calibration, const QuietRule& rule) {
    if (std::min(block.before.multiply_add, block.after.multiply_add) < rule.share * best_calibration) return false;
    if (block.waited_s > (1.0 - rule.share) * block.wall_s) return false;
    return threads > 1 || block.cpu_s >= rule.share * block.wall_s;
}

Summary summarise(const Reading& reading, const BestCalibrations& best, const QuietRule& rule) {
    const auto found = best.find(reading.threads);
    const double best_calibration = found == best.end() ? 0.0 : found->second;
    std::vector<const Block*> counted;
    for (const Block& block : reading.blocks)
        if (is_quiet(block, reading.threads, best_calibration, rule)) counted.push_back(&block);

    Summary summary;
    summary.quiet_blocks = static_cast<int>(counted.size());
    summary.disturbed = summary.quiet_blocks < rule.blocks;
    if (counted.empty())
        for (const Block& block : reading.blocks) counted.push_back(&block);

    summary.best_s = summary.median_s = summary.cpu_s = summary.memory_rate = std::nan("");
    std::vector<double> wall, cpu, memory;
    for (const Block* block : counted) {
        wall.push_back(block->wall_s / block->steps);
        cpu.push_back(block->cpu_s / block->steps);
        memory.push_back(std::min(block->before.memory, block->after.memory));
    }
    if (wall.empty()) return summary;
    summary.best_s = *std::min_element(wall.begin(), wall.end());
    summary.cpu_s = *std::min_element(cpu.begin(), cpu.end());
    summary.median_s = median(std::move(wall));
    summary.memory_rate = median(std::move(memory));
    return summary;
}

double median(std::vector<double> values) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace feldspar::benchmarks
