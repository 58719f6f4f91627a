// Pieces of JSON that the pages and files of studies share. User units; null where a value is not defined. Internal to this room.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "feldspar/output/provenance_json.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/statistics.hpp"

namespace feldspar {

using Json = nlohmann::ordered_json;

/// A number with six digits, null for not-a-number.
Json json_number(double value);

/// {n, mean, low, high, deviation} in user units.
Json interval_json(const MeanInterval& interval, double factor);

/// {name, label, symbol, unit} of a key of PropertySummary.
Json quantity_json(const UserQuantity& quantity);

/// {A: 12, B: 1, C: 0}: how many of the runs have each grade.
Json grades_json(std::span<const TestResult> results);

/// [{point, test, sigma3_MPa, seed, reason}].
Json failures_json(std::span<const PointResults> points);

/// The laboratory's numbers of the job, by their names in user units.
Json laboratory_json(const Job& job);

/// "rigid, 2, 33.1 N/m"; "" without axes.
std::string point_label(const PointResults& point);

/// Runs that are neither done nor failed.
int missing_runs(std::span<const PointResults> points);

/// A number for a CSV file: empty for not-a-number.
std::string csv_number(double value);

/// Writes a file beside itself and renames it when it is whole. @throws OutputError
void write_beside(const std::filesystem::path& file, const std::string& text);

}  // namespace feldspar
