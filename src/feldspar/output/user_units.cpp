// The table of the quantities that users read.
#include "feldspar/output/user_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <numbers>

namespace feldspar {

namespace {

constexpr const char* strength_at = "sigma1_at_sigma3_";  ///< then the pressure, for example "10MPa_Pa"

struct Words {
    const char* property;
    const char* label;
    const char* symbol;
};

/// In the order of a table of results: what a laboratory reports first, then how it was reached.
constexpr auto known = std::to_array<Words>({
    {"E_Pa", "Young's modulus, secant at 50 % of the peak", "E"},
    {"nu", "Poisson's ratio, secant at 50 % of the peak", "\u03bd"},
    {"UCS_Pa", "Uniaxial compressive strength", "UCS"},
    {"DTS_Pa", "Direct tensile strength", "DTS"},
    {"BTS_Pa", "Brazilian tensile strength", "BTS"},
    {"BTS_first_dip_Pa", "Brazilian test, stress at the first fall of 5 %", "BTS dip"},
    {"BTS_largest_Pa", "Brazilian test, largest stress of the record", "BTS largest"},
    {"cohesion_Pa", "Cohesion, Mohr-Coulomb", "c"},
    {"friction_angle_deg", "Friction angle, Mohr-Coulomb", "\u03c6"},
    {"hoek_brown_mi", "Hoek-Brown constant, intact rock", "mi"},
    {"UCS_over_BTS", "Ratio UCS / BTS", "UCS/BTS"},
    {"UCS_over_DTS", "Ratio UCS / DTS", "UCS/DTS"},
    {"BTS_over_DTS", "Ratio BTS / DTS", "BTS/DTS"},
    {strength_at, "", ""},  // stands for the strengths at each lateral pressure
    {"UCS_fitted_Pa", "UCS from the Mohr-Coulomb line", "UCS fit"},
    {"mohr_coulomb_N", "Slope of the Mohr-Coulomb line", "N"},
    {"mohr_coulomb_tension_Pa", "Tensile strength, Mohr-Coulomb line", "\u03c3t M-C"},
    {"hoek_brown_UCS_Pa", "UCS from the Hoek-Brown fit", "\u03c3ci fit"},
    {"hoek_brown_tension_Pa", "Tensile strength, Hoek-Brown parabola", "\u03c3t H-B"},
    {"first_crack_Pa", "Stress at the first crack", "\u03c31st"},
    {"sigma_ci_crack_count_Pa", "Crack initiation stress, crack count", "\u03c3ci"},
    {"sigma_ci_crack_volume_Pa", "Crack initiation stress, crack volumetric strain", "\u03c3ci"},
    {"sigma_ci_lateral_strain_Pa", "Crack initiation stress, lateral strain response", "\u03c3ci"},
    {"sigma_cd_Pa", "Crack damage stress, reversal of the volumetric strain", "\u03c3cd"},
    {"brittleness_k1", "Brittleness k1: above 1 class I, below 1 class II", "k1"},
    {"E_tangent_Pa", "Young's modulus, tangent at 50 % of the peak", "Et50"},
    {"nu_tangent", "Poisson's ratio, tangent at 50 % of the peak", "\u03bd tangent"},
    {"E_average_Pa", "Young's modulus, average 30 to 70 % of the peak", "Eavg"},
    {"E_gauge_Pa", "Young's modulus, tangent, from the gauge", "E gauge"},
    {"E_initial_Pa", "Young's modulus before damage, to 10 % of the peak, from the gauge", "E initial"},
    {"nu_initial", "Poisson's ratio before damage, to 10 % of the peak", "\u03bd initial"},
    {"BTS_valid_share", "Brazilian test valid by ISRM: 1 yes, 0 no", "valid"},
});

bool ends_with_pascal(const std::string& property) { return property.ends_with("_Pa"); }
bool is_modulus(const std::string& property) { return property.starts_with("E_") || property.ends_with("_modulus_Pa"); }

}  // namespace

UserQuantity user_quantity(const std::string& property) {
    UserQuantity quantity;
    quantity.name = property;
    if (ends_with_pascal(property)) {
        quantity.unit = is_modulus(property) ? "GPa" : "MPa";
        quantity.factor = is_modulus(property) ? GPa : MPa;
        quantity.name = property.substr(0, property.size() - 2) + quantity.unit;
    } else if (property.ends_with("_deg")) {
        quantity.unit = "deg";
    }
    quantity.label = quantity.symbol = property;
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (property != known[i].property) continue;
        quantity.label = known[i].label;
        quantity.symbol = known[i].symbol;
        quantity.rank = static_cast<double>(i);
    }
    if (property.starts_with(strength_at)) {
        const double pressure_MPa = std::strtod(property.c_str() + std::strlen(strength_at), nullptr);
        quantity.label = fmt::format("Strength at \u03c3\u2083 = {:.6g} MPa", pressure_MPa);
        quantity.symbol = "\u03c3\u2081";
        const auto place = std::ranges::find(known, strength_at, &Words::property);
        quantity.rank = static_cast<double>(place - known.begin()) +
                        pressure_MPa / (1.0 + pressure_MPa);  // growing pressure, below the next rank
    }
    return quantity;
}

std::string property_of_laboratory(const std::string& name) {
    if (name == "friction_angle") return "friction_angle_deg";
    if (name == "nu" || name == "nu_tangent" || name == "nu_initial" || name == "hoek_brown_mi" || name.find("_over_") != std::string::npos) return name;
    return name + "_Pa";
}

double laboratory_in_user_units(const std::string& name, double value) {
    if (name == "friction_angle") return value * 180.0 / std::numbers::pi;
    return value * user_quantity(property_of_laboratory(name)).factor;
}

}  // namespace feldspar
