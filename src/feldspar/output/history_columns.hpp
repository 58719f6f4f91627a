// The columns of a history, once for every format: name, unit, meaning and where the number comes from.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// One column. Stresses in MPa, displacements in mm, energies in J; compression positive.
struct HistoryColumn {
    const char* name;  ///< "axial_stress_MPa"
    const char* unit;  ///< "MPa"; "1" for a pure number
    const char* meaning;
    bool whole;  ///< a count: written without a decimal point
    double (*value)(const HistoryRow& row);
};

/// All columns, in the order of the files.
std::span<const HistoryColumn> history_columns();

/// A column of the files of one test.
struct FileColumn {
    std::string name, unit, meaning;
    bool whole = false;
    std::function<double(const HistoryRow&)> value;
};

/// The columns of a test: all of the above, but for strains in the middle of a specimen that is not strained evenly, then those
/// of its gauges.
std::vector<FileColumn> history_columns(const TestResult& result);

/// How a gauge's readings are given to users: "mm", "1" or "kN", and times what.
struct GaugeUnit {
    const char* name;
    double factor;
};
GaugeUnit unit_of(const GaugeSpec& gauge);

/// The sentence on signs that every file of results carries.
inline constexpr const char* sign_convention =
    "compression positive for stresses and strains, as in rock mechanics; a tension test runs negative; strengths are positive "
    "magnitudes";

}  // namespace feldspar
