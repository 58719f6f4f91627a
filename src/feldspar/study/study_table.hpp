// A study as tables: its points with the mean and the 95 % interval of each property, and its runs one by one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "feldspar/study/point_results.hpp"

namespace feldspar {

/// Properties that any point has, in the order of reports; keys of PropertySummary.
std::vector<std::string> properties_of(std::span<const PointResults> points);

/// The main properties of each point for a terminal, mean +- half of the 95 % interval, user units. @param columns  of the
/// terminal; 0: of none
std::string study_text(const Study& study, std::span<const PointResults> points, std::size_t columns = 0);

/// CSV: a row a point; the axes, then for each property mean, bounds of the 95 % interval and number of packings, user units,
/// empty where not defined.
std::string points_csv(const Study& study, std::span<const PointResults> points);

/// CSV: a row a run; the axes, seed, test and state, then the ledger's numbers in its units (SI).
std::string runs_csv(const Study& study, const Ledger& ledger);

/// "UCS_MPa" and "12.3 GPa" as cells of a CSV: quoted where a comma, a quote or a line end asks for it; control characters as
/// escapes such as \x1b. Text that a spreadsheet would take for a formula ("=1+1", "@a", "-a") gets an apostrophe before it;
/// numbers with their unit do not.
std::string csv_cell(const std::string& text);

}  // namespace feldspar
