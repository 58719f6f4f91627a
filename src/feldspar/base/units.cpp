#include "feldspar/base/units.hpp"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

struct DimensionEntry {
    Dimension dimension;
    const char* si;           // udunits spelling of the SI unit
    const char* written;      // how format_si writes it
    const char* description;  // with its article
    const char* example;
};

constexpr std::array<DimensionEntry, 14> dimension_table{{
    {Dimension::length, "m", "m", "a length", "80 mm"},
    {Dimension::stress, "Pa", "Pa", "a stress", "25.8 GPa"},
    {Dimension::density, "kg m-3", "kg/m3", "a density", "2650 kg/m3"},
    {Dimension::stiffness_gradient, "Pa m-1", "Pa/m", "a stiffness per area", "18e4 GPa/m"},
    {Dimension::fracture_energy, "J m-2", "N/m", "a fracture energy", "20 N/m"},
    {Dimension::speed, "m s-1", "m/s", "a speed", "0.05 m/s"},
    {Dimension::speed_per_step, "m", "m/step", "a length per step", "6.25e-9 m/step"},
    {Dimension::time, "s", "s", "a time", "1e-8 s"},
    {Dimension::angle, "radian", "rad", "an angle", "53 deg"},
    {Dimension::force, "N", "N", "a force", "5 kN"},
    {Dimension::energy, "J", "J", "an energy", "50 mJ"},
    {Dimension::acceleration, "m s-2", "m/s2", "an acceleration", "9.81 m/s2"},
    {Dimension::toughness, "Pa", "Pa m^0.5", "a fracture toughness",
     "0.9 MPa m^0.5"},  // the root of the metre is taken off before udunits reads the rest
    {Dimension::fraction, "1", "", "a fraction", "0.5 %"},
}};

const DimensionEntry& entry_of(Dimension dimension) { return dimension_table[static_cast<std::size_t>(dimension)]; }

// Symbols as they are rightly written. A symbol that is one of these but for the case of its letters is refused: udunits
// would take some of them (mPa, Mm) for something a million or a thousand million times smaller or larger.
constexpr std::array<std::string_view, 44> proper_symbols{
    "m",   "mm",   "cm",  "dm",  "um", "nm", "km",  "in", "ft",  "Pa",  "hPa",    "kPa",     "MPa",    "GPa",    "TPa",
    "bar", "kbar", "psi", "ksi", "g",  "kg", "Mg",  "mg", "t",   "N",   "mN",     "kN",      "MN",     "J",      "mJ",
    "kJ",  "MJ",   "s",   "ms",  "us", "ns", "min", "h",  "rad", "deg", "degree", "degrees", "radian", "radians"};

bool same_but_for_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char p, char q) {
        return std::tolower(static_cast<unsigned char>(p)) == std::tolower(static_cast<unsigned char>(q));
    });
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

std::string allowed_text(Dimension dimension) {
    return std::string(describe(dimension)) + " with its unit, such as \"" + std::string(example(dimension)) + "\"";
}

[[noreturn]] void refuse(Dimension dimension, std::string problem, std::string suggestion = {}) {
    throw InputError({}, std::move(problem), allowed_text(dimension), std::move(suggestion));
}

struct Symbol {
    std::size_t begin = 0;  // in the unit text
    std::size_t length = 0;
};

bool is_symbol_byte(char c) {  // letters, %, and every byte of a non-ASCII character (the degree sign, the micro sign)
    return std::isalpha(static_cast<unsigned char>(c)) || c == '%' || static_cast<unsigned char>(c) >= 0x80;
}

// Splits a unit such as "kg/m3", "N m-1" or "GPa·m^-1" into its symbols. The grammar is narrower than that of udunits:
// symbols with whole exponents, joined by blanks, '.', '*' or '/'; no numbers, no brackets, no fractions.
std::optional<std::vector<Symbol>> symbols_of(std::string_view unit) {
    std::vector<Symbol> symbols;
    std::size_t i = 0;
    const auto skip_blanks = [&] {
        while (i < unit.size() && unit[i] == ' ') ++i;
    };
    const auto is_digit = [&](std::size_t k) { return k < unit.size() && std::isdigit(static_cast<unsigned char>(unit[k])); };
    for (;;) {
        skip_blanks();
        const std::size_t begin = i;
        while (i < unit.size() && is_symbol_byte(unit[i])) ++i;
        if (i == begin) return std::nullopt;
        symbols.push_back({begin, i - begin});
        if (unit.substr(i, 2) == "**")
            i += 2;
        else if (i < unit.size() && unit[i] == '^')
            ++i;
        if (i < unit.size() && (unit[i] == '-' || unit[i] == '+')) {
            if (!is_digit(i + 1)) return std::nullopt;
            ++i;
        }
        while (is_digit(i)) ++i;
        skip_blanks();
        if (i == unit.size()) return symbols;
        if (unit[i] == '.' || unit[i] == '*' || unit[i] == '/')
            ++i;
        else if (unit[i - 1] != ' ')
            return std::nullopt;
    }
}

// The unit table, read once; the parser of udunits keeps static state, so one caller at a time.
class UnitSystem {
public:
    static UnitSystem& instance() {
        static UnitSystem system;
        return system;
    }

    /// Factor from `unit` to the SI unit of `dimension`; 0 when the dimension is another, absent when the unit is unknown.
    std::optional<double> factor(const std::string& unit, Dimension dimension) {
        const std::lock_guard lock(mutex_);
        ut_unit* from = ut_parse(system_, unit.c_str(), UT_UTF8);
        if (from == nullptr) return std::nullopt;
        ut_unit* to = ut_parse(system_, entry_of(dimension).si, UT_UTF8);
        double result = 0.0;
        if (cv_converter* converter = ut_get_converter(from, to); converter != nullptr) {
            const double one = cv_convert_double(converter, 1.0);
            // udunits also offers the reciprocal (1/Pa to Pa) and scales with an offset: only a plain factor is ours
            const bool plain = cv_convert_double(converter, 0.0) == 0.0 &&
                               std::abs(cv_convert_double(converter, 2.0) - 2.0 * one) <= 1e-12 * one;
            if (plain) result = one;
            cv_free(converter);
        }
        ut_free(to);
        ut_free(from);
        return result;
    }

private:
    UnitSystem() {
        ut_set_error_message_handler(ut_ignore);
        system_ = ut_read_xml(nullptr);
        if (system_ == nullptr)
            throw InputError({}, "the unit table of udunits2 (udunits2.xml) cannot be read",
                             "its place in the variable UDUNITS2_XML_PATH");
    }
    ut_system* system_ = nullptr;
    std::mutex mutex_;
};

// value x factor with one rounding when the factor is a power of ten, as udunits holds 1e-3 and 999.99999999999989 for 1000.
double scaled(double value, double factor) {
    const double exponent = std::round(std::log10(factor));
    if (std::abs(exponent) <= 22.0) {
        const double power = std::pow(10.0, std::abs(exponent));  // exact up to 1e22
        const double target = exponent < 0.0 ? 1.0 / power : power;
        if (std::abs(factor - target) <= 1e-14 * target) return exponent < 0.0 ? value / power : value * power;
    }
    return value * factor;
}

void guard_symbols(std::string_view text, std::string_view unit, const std::vector<Symbol>& symbols, Dimension dimension) {
    for (const Symbol& symbol : symbols) {
        const std::string_view word = unit.substr(symbol.begin, symbol.length);
        if (std::find(proper_symbols.begin(), proper_symbols.end(), word) != proper_symbols.end()) {
            continue;
        }
        for (std::string_view proper : proper_symbols) {
            if (!same_but_for_case(word, proper)) continue;
            const std::string meaning = word == "mPa" ? " is a thousandth of a pascal" : " is not a unit used here";
            std::string better(unit);
            better.replace(symbol.begin, symbol.length, proper);
            refuse(dimension, quoted(text) + ": '" + std::string(word) + "'" + meaning, "did you mean '" + better + "'?");
        }
    }
}

[[noreturn]] void refuse_dimension(std::string_view text, const std::string& unit, Dimension wanted) {
    for (const DimensionEntry& other : dimension_table) {
        if (other.dimension == wanted || other.dimension == Dimension::speed_per_step) continue;
        if (other.dimension == Dimension::angle || other.dimension == Dimension::fraction ||
            other.dimension == Dimension::toughness)
            continue;
        if (UnitSystem::instance().factor(unit, other.dimension).value_or(0.0) != 0.0)
            refuse(wanted, quoted(text) + " is " + other.description + ", not " + std::string(describe(wanted)));
    }
    refuse(wanted, quoted(text) + " is not " + std::string(describe(wanted)));
}

// "MPa m^0.5" without the root of the metre; nothing where there is none.
std::optional<std::string> without_root(std::string_view unit) {
    for (const std::string_view root : {"m^0.5", "m0.5", "m^1/2", "m1/2", "m^(1/2)", "sqrt(m)", "sqrt m", "\xE2\x88\x9Am"}) {
        if (!unit.ends_with(root)) continue;
        std::string_view rest = unit.substr(0, unit.size() - root.size());
        const bool joined = !rest.empty() && (rest.back() == ' ' || rest.back() == '.' || rest.back() == '*');
        if (joined) return std::string(trimmed(rest.substr(0, rest.size() - 1)));
    }
    return std::nullopt;
}

bool is_angle_symbol(std::string_view word) {
    constexpr std::array<std::string_view, 9> names{"deg", "degree", "degrees", "\xC2\xB0", "arc_degree",
                                                    "rad", "radian", "radians", "mrad"};
    return std::find(names.begin(), names.end(), word) != names.end();
}

double convert_angle(std::string_view text, double value, std::string_view unit) {
    if (!is_angle_symbol(unit)) {
        if (unit == "%") refuse(Dimension::angle, quoted(text) + " is a fraction, not an angle");
        if (!UnitSystem::instance().factor(std::string(unit), Dimension::angle))
            refuse(Dimension::angle, quoted(text) + ": unknown unit '" + std::string(unit) + "'");
        refuse_dimension(text, std::string(unit), Dimension::angle);
    }
    if (unit == "rad" || unit == "radian" || unit == "radians") return value;
    if (unit == "mrad") return value / 1000.0;
    return value * (3.14159265358979323846 / 180.0);
}

}  // namespace

std::string_view describe(Dimension dimension) { return entry_of(dimension).description; }
std::string_view example(Dimension dimension) { return entry_of(dimension).example; }

std::string format_exact(double value) {
    std::array<char, 40> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return std::string(buffer.data(), error == std::errc{} ? end : buffer.data());
}

std::string format_si(double value, Dimension dimension) {
    const std::string unit = entry_of(dimension).written;
    return unit.empty() ? format_exact(value) : format_exact(value) + " " + unit;
}

double parse_quantity(std::string_view text, Dimension dimension) {
    const std::string_view whole = trimmed(text);
    if (whole.empty()) refuse(dimension, "the text is empty");

    std::string_view rest = whole;
    if (rest.size() > 1 && rest.front() == '+' && rest[1] != '-') rest.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error == std::errc::invalid_argument) refuse(dimension, quoted(whole) + " does not begin with a number");
    if (error == std::errc::result_out_of_range) refuse(dimension, quoted(whole) + ": the number is out of range");
    if (!std::isfinite(value)) refuse(dimension, quoted(whole) + " is not a finite number");
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));

    const std::string_view unit_text = trimmed(rest);
    if (!unit_text.empty() && unit_text.front() == ',' && rest.front() == ',')
        refuse(dimension, quoted(whole) + ": the decimal sign is a point, not a comma");
    if (unit_text.empty()) {
        if (dimension == Dimension::fraction) return value;
        refuse(dimension, quoted(whole) + " has no unit");
    }

    std::string unit(unit_text);
    std::replace_if(
        unit.begin(), unit.end(), [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }, ' ');
    if (dimension == Dimension::speed_per_step && unit.ends_with("step")) {  // "m/step": a step is a count, not a unit
        const std::string_view before = trimmed(std::string_view(unit).substr(0, unit.size() - 4));
        if (before.size() > 1 && before.back() == '/') unit = std::string(trimmed(before.substr(0, before.size() - 1)));
    }

    if (dimension == Dimension::toughness) {
        const std::optional<std::string> stress = without_root(unit);
        if (!stress) refuse(dimension, quoted(whole) + " is not a fracture toughness");
        unit = *stress;
    }

    const std::optional<std::vector<Symbol>> symbols = symbols_of(unit);
    if (!symbols) refuse(dimension, quoted(whole) + ": '" + unit + "' is not a unit");
    guard_symbols(whole, unit, *symbols, dimension);
    if (dimension == Dimension::angle && symbols->size() == 1) return convert_angle(whole, value, unit);
    if (dimension == Dimension::fraction) {
        if (unit == "%" || unit == "percent") return value / 100.0;
        if (symbols->size() == 1 && is_angle_symbol(unit)) refuse(dimension, quoted(whole) + " is an angle, not a fraction");
        if (!UnitSystem::instance().factor(unit, dimension)) refuse(dimension, quoted(whole) + ": unknown unit '" + unit + "'");
        refuse_dimension(whole, unit, dimension);
    }
    for (const Symbol& symbol :
         *symbols) {  // udunits takes angles and percent for pure numbers: "5 MPa %" would pass as a stress
        const std::string_view word = std::string_view(unit).substr(symbol.begin, symbol.length);
        if (is_angle_symbol(word))
            refuse(dimension, quoted(whole) +
                                  (symbols->size() == 1 ? " is an angle, not " : " has an angle in its unit and is not ") +
                                  std::string(describe(dimension)));
        if (word == "%" || word == "percent")
            refuse(dimension, quoted(whole) +
                                  (symbols->size() == 1 ? " is a fraction, not " : " has a percentage in its unit and is not ") +
                                  std::string(describe(dimension)));
    }

    const std::optional<double> factor = UnitSystem::instance().factor(unit, dimension);
    if (!factor) refuse(dimension, quoted(whole) + ": unknown unit '" + unit + "'");
    if (*factor == 0.0) refuse_dimension(whole, unit, dimension);
    const double result = scaled(value, *factor);
    if (!std::isfinite(result)) refuse(dimension, quoted(whole) + " is not a finite number in SI");
    return result;
}

}  // namespace feldspar
