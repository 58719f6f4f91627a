// What the variants of a job have to say side by side: the properties of each, and what a step costs.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "feldspar/job/job.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// The results of one variant, drawn together.
struct VariantSummary {
    const Variant* variant = nullptr;  ///< points into the job
    PropertySummary properties;
    std::map<MethodId, double> ms_per_step;  ///< median over its tests of a kind
};

/// One for each variant of the job, in its order; those without results are there with nothing in them.
std::vector<VariantSummary> summarise_variants(const Job& job, std::span<const TestResult> results);

/// The share of the contact area between grains that is broken after the first n cracks, n = 0, 1, ..., 0 to 1.
std::vector<double> broken_share(const TestResult& result);

}  // namespace feldspar
