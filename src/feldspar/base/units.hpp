// Quantities in the user's words: "25.8 GPa" -> 25.8e9. Everything inside Feldspar is SI; this is the only door.
//
// The unit table is udunits2's. Its traps are closed here: it has no `deg`, reads `4 mPa` as a thousandth of a pascal and
// `MPa m1/2` as half a MPa m, takes `Mm` for a megametre, and would convert 1/Pa to Pa by taking the reciprocal.
#pragma once

#include <string>
#include <string_view>

namespace feldspar {

/// What kind of quantity a key holds. In brackets: the SI unit of the parsed value.
enum class Dimension {
    length,              ///< [m]
    stress,              ///< [Pa] also moduli and strengths
    density,             ///< [kg/m3]
    stiffness_gradient,  ///< [Pa/m] contact stiffness per area: "18e4 GPa/m"
    fracture_energy,     ///< [J/m2] also as N/m, which is the same
    speed,               ///< [m/s]
    speed_per_step,      ///< [m a step] written as a length, with or without "/step"
    time,                ///< [s]
    angle,               ///< [rad] deg, degree or rad
    force,               ///< [N]
    energy,              ///< [J]
    acceleration,        ///< [m/s2] "9.81 m/s2"
    toughness,           ///< [Pa sqrt(m)] fracture toughness: "0.9 MPa m^0.5", also "MPa sqrt(m)" and "MPa m1/2"
    fraction,            ///< [1] "0.5 %"; a bare number is taken as it stands
};

/// Reads a number with its unit, such as "25.8 GPa", and gives it in SI. Blanks around number and unit are allowed; the
/// conversion adds no rounding where the unit is a power of ten of the SI unit.
/// @throws InputError (without a place, which the caller adds) when number or unit is missing, the unit is unknown or of
///         another dimension, the number is not finite, or something follows.
double parse_quantity(std::string_view text, Dimension dimension);

/// "a length", "a stress", ...
std::string_view describe(Dimension dimension);

/// How such a quantity is written: "80 mm", "25.8 GPa", ...
std::string_view example(Dimension dimension);

/// The value in its SI unit with as many digits as it takes to read back the same bits: "0.08 m".
std::string format_si(double value, Dimension dimension);

/// The number alone, with as many digits as it takes to read back the same bits: "0.08".
std::string format_exact(double value);

}  // namespace feldspar
