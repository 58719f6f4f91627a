// report.html of a study: its points as a table, and any property over any axis as a chart.
#pragma once

#include <filesystem>
#include <span>

#include "feldspar/study/point_results.hpp"

namespace feldspar {

/// Writes the page; `points` as point_results() gives them, whole or not. It is self-contained and asks the network for nothing.
/// @throws OutputError when the file cannot be written
void write_study_report(const Study& study, std::span<const PointResults> points, const std::filesystem::path& file);

}  // namespace feldspar
