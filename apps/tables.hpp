// What `feldspar run` prints at its end.
#pragma once

#include <span>
#include <string>

#include "feldspar/job/job.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

/// Properties of the rock: median, range, number of packings, and the laboratory's value with the deviation from it.
/// @param columns  of the terminal, here and below; 0: of no terminal
std::string property_table(const Job& job, const PropertySummary& properties, std::size_t columns = 0);

/// One row a variant: the main properties, median and range; then the time of a step.
std::string variant_table(const Job& job, std::span<const TestResult> results, std::size_t columns = 0);

/// The verdict says that the strength is less certain than the accuracy that the job asks for (without one: the usual accuracy).
bool worse_than_asked(const TestResult& result);

/// The tests one by one: peak, cracks, steps, time, energy residual and grade; below them those that failed, and why, and the
/// verdict in words of those that are worse than asked.
std::string test_table(std::span<const TestResult> results, std::span<const FailedTest> failed = {}, std::size_t columns = 0);

/// One line for a test that has just ended.
std::string test_line(const TestResult& result);

}  // namespace feldspar
