// What the ledger knows of the points of a study.
#pragma once

#include <vector>

#include "feldspar/lab/properties.hpp"
#include "feldspar/study/ledger.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// The runs of one point, drawn together.
struct PointResults {
    std::vector<AxisValue> values;    ///< as Point::values
    std::vector<TestResult> results;  ///< of the runs that are done: what summarise() reads, and grade, steps and times
    PropertySummary properties;       ///< of these; PropertyStatistics::values holds the value of each packing
    std::vector<RunRecord> failed;
    int missing = 0;  ///< runs that are neither done nor failed
};

/// One for each point, in the study's order.
std::vector<PointResults> point_results(const Study& study, const Ledger& ledger);

}  // namespace feldspar
