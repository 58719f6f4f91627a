// Two reports side by side: where a case became slower, and whether that can be believed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/report.hpp"

namespace feldspar::benchmarks {

inline constexpr double kNotableChange = 0.05;  ///< smaller changes are not marked
inline constexpr double kSameMemory = 0.20;     ///< memory rates that differ by more make two readings incomparable

/// A case that both reports have.
struct Change {
    std::string name;
    double old_s = 0.0, new_s = 0.0;  ///< best, a step
    double ratio = 1.0;               ///< new / old
    bool disturbed = false;           ///< either reading
    double memory_ratio = 1.0;        ///< rates at which the shared cache could be read, new / old
    bool same_specimen = true;        ///< as many grains, triangles and points in both

    bool slower() const { return trusted() && ratio > 1.0 + kNotableChange; }
    bool faster() const { return trusted() && ratio < 1.0 / (1.0 + kNotableChange); }
    bool same_memory() const { return memory_ratio < 1.0 + kSameMemory && memory_ratio > 1.0 / (1.0 + kSameMemory); }
    bool trusted() const { return !disturbed && same_specimen && same_memory(); }
};

struct Comparison {
    std::vector<Change> changes;        ///< in the order of the new report
    std::vector<std::string> only_old;  ///< cases that only one of them has
    std::vector<std::string> only_new;
    std::vector<std::string> differences;  ///< between machines, compilers and builds, a line each: ratios then mean little
};

/// By name. A case measured twice in a report counts with its first reading.
Comparison compare(const Report& before, const Report& after);

/// The largest slowdown in percent of the trusted cases (10 if one takes 1.1 times as long; negative if all are faster); none
/// without such cases.
std::optional<double> worst_slowdown_percent(const Comparison& comparison);

}  // namespace feldspar::benchmarks
