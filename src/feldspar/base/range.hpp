// The allowed values of a number.
#pragma once

#include <limits>
#include <string_view>

namespace feldspar {

/// The allowed values of a number, with the words that say so.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_allowed = true;
    bool high_allowed = true;
    std::string_view words = "any finite number";

    bool contains(double v) const { return (low_allowed ? v >= low : v > low) && (high_allowed ? v <= high : v < high); }
};

inline constexpr Range any_value{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), false, true, "greater than zero"};
inline constexpr Range not_negative{0.0, std::numeric_limits<double>::infinity(), true, true, "zero or greater"};

}  // namespace feldspar
