// How numbers of results are kept, and how users read them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "feldspar/base/units.hpp"

namespace feldspar {

inline constexpr double MPa = 1e-6;  ///< times Pa
inline constexpr double GPa = 1e-9;  ///< times Pa

/// How a number is kept, and how users read it.
struct QuantityUnit {
    std::string_view kept;  ///< SI, but "deg" for angles; "" for a pure number
    std::string_view user;
    double factor = 1.0;                 ///< value for the user = factor x value that is kept
    std::optional<Dimension> written{};  ///< how files of users give it; none for a pure number, and for what they do not give

    bool operator==(const QuantityUnit&) const = default;
    /// "E_Pa": as a number that is kept is called
    std::string kept_name(std::string_view stem) const { return with_unit(stem, kept); }
    /// "E_GPa": as users meet it
    std::string user_name(std::string_view stem) const { return with_unit(stem, user); }

private:
    static std::string with_unit(std::string_view stem, std::string_view unit) {
        std::string name(stem);
        if (!unit.empty()) name.append("_").append(unit);
        return name;
    }
};

namespace units {
inline constexpr QuantityUnit pure{"", ""}, stress{"Pa", "MPa", MPa, Dimension::stress},
    modulus{"Pa", "GPa", GPa, Dimension::stress}, angle{"deg", "deg", 1.0, Dimension::angle},
    length{"m", "mm", 1e3, Dimension::length}, force{"N", "kN", 1e-3, Dimension::force},
    toughness{"Pa_sqrt_m", "MPa_sqrt_m", MPa, Dimension::toughness},
    fracture_work{"J_m2", "J_m2", 1.0, Dimension::fracture_energy}, energy{"J", "J"}, duration{"s", "s", 1.0, Dimension::time};
}

}  // namespace feldspar
