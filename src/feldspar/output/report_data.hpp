// What the report's page is told, as JSON: the C++ side writes data only, the page in assets/ lays it out.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "feldspar/output/results.hpp"

namespace feldspar {

/// Everything but the fields: job, properties, envelope, tests with thinned histories, failed tests, provenance. User units,
/// compression positive, null where a value is not defined.
nlohmann::ordered_json report_data(const Job& job, std::span<const TestResult> results, const PropertySummary& properties,
                                   const Provenance& provenance, bool complete, std::span<const FailedTest> failed);

/// Fields of one test for the viewer of the failure pattern.
struct ReportFields {             // NOLINT(bugprone-exception-escape): moving the JSON throws nothing
    nlohmann::ordered_json meta;  ///< what lies where in the block, ranges, snapshots
    std::string block;            ///< zlib-compressed, base64
};

/// Of each kind (and sigma_3) the fields of the packings with the median, the smallest and the largest strength, as many as fit
/// into `budget_B` characters; of a job with variants those of the first packing of each variant and kind. A test that does not
/// fit into its share as a whole keeps fewer moments: first crack, peak and end at last, or its end alone. One that does not fit
/// then either, or has more than 100,000 triangles, is drawn in squares that have the means of the grains in them (squares.hpp);
/// one that would need fewer than 1,000 squares is left out.
std::vector<ReportFields> report_fields(std::span<const TestResult> results, std::size_t budget_B);

/// The cracks of every test over the grains of its packing, one block a packing: for patterns side by side.
std::vector<ReportFields> report_patterns(std::span<const TestResult> results);

/// The row of the history that first shows the strength, of a Brazilian test the first peak; the last one if none does.
std::size_t strength_row(const TestResult& result);

/// A row's rounded value: six digits are more than a screen shows.
nlohmann::ordered_json rounded(double value);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace feldspar
