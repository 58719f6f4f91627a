// The page of a study: its points as a table, and any property over any axis as a chart.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "feldspar/study/point_results.hpp"

namespace feldspar {

/// Where the page stands: `results`/<name>.html, for studies may share their results.
inline std::filesystem::path study_page(const Study& study) { return study.results / (study.name + ".html"); }

/// The points with their properties for programs: `name`, `title`, `axes`, `points` (each with `labels` and `numbers` by axis,
/// `properties` by name (n, mean, low, high, deviation, seeds, values), `grades`, and how many runs are done, failed, missing),
/// `failures`, `laboratory`. User units; null where a value is not defined.
std::string study_json(const Study& study, std::span<const PointResults> points);

/// Writes the page; `points` as point_results() gives them, whole or not. It is self-contained and asks the network for nothing.
/// @throws OutputError when the file cannot be written
void write_study_report(const Study& study, std::span<const PointResults> points, const std::filesystem::path& file);

}  // namespace feldspar
