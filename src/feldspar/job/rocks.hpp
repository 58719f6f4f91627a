// Rocks of the literature with what laboratories have measured on them.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace feldspar {

/// Not-a-number where the source says nothing.
struct LiteratureRock {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::string_view name;    ///< "lac-du-bonnet-granite": the word behind the last hyphen says what it is
    std::string_view source;  ///< authors, where, year
    double E_GPa = unknown;
    double nu = unknown;
    double UCS_MPa = unknown;
    double BTS_MPa = unknown;  ///< Brazilian, or what the source calls tensile strength
    double cohesion_MPa = unknown;
    double friction_angle_deg = unknown;
};

/// All of them.
std::span<const LiteratureRock> literature_rocks();

/// The rock of this name, or the first of this kind ("granite"). @throws InputError for any other word, with the names
const LiteratureRock& literature_rock(std::string_view name);

}  // namespace feldspar
