// What the program prints: text of a user's is in it, and must not command the terminal.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "feldspar/base/printable.hpp"

namespace feldspar {

/// Prints like fmt::print, with control characters as escapes.
template <class... Values>
void say(std::FILE* where, fmt::format_string<Values...> format, Values&&... values) {
    fmt::print(where, "{}", printable(fmt::format(format, std::forward<Values>(values)...)));
}

/// The same on stdout.
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
    say(stdout, format, std::forward<Values>(values)...);
}

}  // namespace feldspar
