// The goals: what the step is meant to cost one day. Not limits; no test and no exit code depends on them.
#pragma once

#include <optional>
#include <string>

namespace feldspar::benchmarks {

struct Goal {
    const char* case_name;
    int vector_bits;      ///< the goal counts on machines whose vectors are at least this wide
    double milliseconds;  ///< a step
};

/// Of an undisturbed core that makes about 120 GFLOP/s in double precision with vectors of 512 bits, 60 with 256.
inline constexpr Goal kGoals[] = {
    {"flexible/uniaxial/paper/elastic/step/1t", 256, 0.25}, {"flexible/uniaxial/paper/elastic/step/1t", 512, 0.15},
    {"flexible/uniaxial/paper/elastic/step/2t", 512, 0.08}, {"rigid/uniaxial/paper/elastic/step/1t", 256, 0.06},
    {"flexible/uniaxial/100k/elastic/step/2t", 256, 14.0},
};

/// Memory of the assembly a flexible grain, bytes.
inline constexpr double kGoalBytesPerGrain = 8000.0;

/// The goal of a case on this machine: that of the widest vectors that it has.
inline std::optional<double> goal_milliseconds(const std::string& case_name, int vector_bits) {
    std::optional<double> milliseconds;
    int widest = 0;
    for (const Goal& goal : kGoals) {
        if (case_name != goal.case_name || goal.vector_bits > vector_bits || goal.vector_bits < widest) continue;
        widest = goal.vector_bits;
        milliseconds = goal.milliseconds;
    }
    return milliseconds;
}

}  // namespace feldspar::benchmarks
