// From SI to the units that a rock-mechanics user reads, and the names that carry them.
#pragma once

#include <string>

#include "feldspar/lab/quantities.hpp"

namespace feldspar {

/// A quantity in user units: its name in summary.json, the factor from SI, the unit and the words of a table.
struct UserQuantity {
    std::string name;      ///< "E_GPa", "UCS_MPa", "nu"
    double factor = 1.0;   ///< value in user units = factor x value in SI
    std::string unit;      ///< "GPa", "MPa", "deg", "" (dimensionless)
    std::string label;     ///< "Uniaxial compressive strength"; the name itself for a quantity not known here
    std::string symbol;    ///< "UCS", "E", "phi"
    double rank = 1000.0;  ///< order in tables
};

/// Translates a key of PropertySummary: "E_Pa" to E_GPa, other "..._Pa" to MPa, the rest stays.
UserQuantity user_quantity(const std::string& property);

/// Translates a key of Job::laboratory ("E", "UCS", "friction_angle") to the key of PropertySummary that it compares with
/// ("E_Pa", "UCS_Pa", "friction_angle_deg").
std::string property_of_laboratory(const std::string& name);

/// A value of Job::laboratory (SI, radians) as PropertySummary has it (SI, degrees).
double laboratory_as_kept(const std::string& name, double value);

/// A value of Job::laboratory (SI, radians) in user units.
double laboratory_in_user_units(const std::string& name, double value);

}  // namespace feldspar
