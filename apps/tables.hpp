// What `feldspar run` prints at its end.
#pragma once

#include <span>
#include <string>

#include "feldspar/lab/properties.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

/// Properties of the rock: median, range, number of packings, and the laboratory's value with the deviation from it.
std::string property_table(const Job& job, const PropertySummary& properties);

/// One row a variant: the main properties, median and range; then the time of a step.
std::string variant_table(const Job& job, std::span<const TestResult> results);

/// The tests one by one: peak, cracks, steps, time, energy residual, and the verdict in words; below them those that failed, and why.
std::string test_table(std::span<const TestResult> results, std::span<const FailedTest> failed = {});

/// One line for a test that has just ended.
std::string test_line(const TestResult& result);

}  // namespace feldspar
