// Two reports side by side: where a case became slower, and whether that can be believed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/report.hpp"

namespace feldspar::benchmarks {

inline constexpr double kNotableChange = 0.05;   ///< smaller changes are not marked

/// A case that both reports have.
struct Change {
    std::string name;
    double old_s = 0.0, new_s = 0.0;   ///< best, a step
    double ratio = 1.0;                ///< new / old
    bool disturbed = false;            ///< either reading
    bool same_specimen = true;         ///< as many grains, triangles and points in both

    bool slower() const { return trusted() && ratio > 1.0 + kNotableChange; }
    bool faster() const { return trusted() && ratio < 1.0 / (1.0 + kNotableChange); }
    bool trusted() const { return !disturbed && same_specimen; }
};

struct Comparison {
    std::vector<Change> changes;             ///< in the order of the new report
    std::vector<std::string> only_old;       ///< cases that only one of them has
    std::vector<std::string> only_new;
    std::vector<std::string> differences;    ///< between machines, compilers and builds, a line each: ratios then mean little
};

/// By name. A case measured twice in a report counts with its first reading.
Comparison compare(const Report& before, const Report& after);

/// The largest slowdown in percent of the trusted cases (10 if one takes 1.1 times as long; negative if all are faster); none without such cases.
std::optional<double> worst_slowdown_percent(const Comparison& comparison);

}  // namespace feldspar::benchmarks
