// Words of files that are read as they stand: numbers without units, texts without blanks around them. Quantities with units:
// base/units.hpp.
#pragma once

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

namespace feldspar {

/// The text without blanks around it.
inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
    return text;
}

namespace plain_text_detail {

template <class Number>
std::optional<Number> all_of(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace plain_text_detail

/// The finite number that the whole text is, whatever the locale; nothing if it is none.
inline std::optional<double> finite_number(std::string_view text) {
    const std::optional<double> value = plain_text_detail::all_of<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

/// The whole number that the whole text is; nothing if it is none, or does not fit.
template <class Whole = long long>
std::optional<Whole> whole_number(std::string_view text) {
    return plain_text_detail::all_of<Whole>(text);
}

}  // namespace feldspar
