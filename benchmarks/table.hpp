// Reports and comparisons as tables for the terminal.
#pragma once

#include <string>

#include "benchmarks/compare.hpp"
#include "benchmarks/report.hpp"

namespace feldspar::benchmarks {

/// Where it was measured, and every reading: times a step, a piece and a second, memory, goals, and which readings stayed
/// disturbed.
std::string report_table(const Report& report);

/// Ratios new / old, marked where a case became slower or faster by more than 5 % and both readings were undisturbed.
std::string comparison_table(const Comparison& comparison);

/// A time a step with its unit, for example "0.7314 ms".
std::string time_text(double seconds);

}  // namespace feldspar::benchmarks
