// A share in words.
#pragma once

#include <fmt/format.h>

#include <string>

namespace feldspar {

/// "0.25 %" for 0.0025: two digits, and from 100 % on all before the point.
inline std::string per_cent(double share) {
    const double value = 100.0 * share;
    return value < 99.5 ? fmt::format("{:.2g} %", value) : fmt::format("{:.0f} %", value);
}

}  // namespace feldspar
