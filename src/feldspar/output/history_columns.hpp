// The columns of a history, once for every format: name, unit, meaning and where the number comes from.
#pragma once

#include <span>

#include "feldspar/lab/result.hpp"

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

/// The sentence on signs that every file of results carries.
inline constexpr const char* sign_convention =
    "compression positive for stresses and strains, as in rock mechanics; a tension test runs negative; strengths are positive "
    "magnitudes";

}  // namespace feldspar
