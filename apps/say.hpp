// What the program prints: text of a user's is in it, and must not command the terminal.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

#include "feldspar/base/printable.hpp"

namespace feldspar {

/// Prints as it is. Nobody may be reading: that is no reason to end a run, and guarded() in feldspar.cpp tells of it for stdout.
inline void put(std::FILE* where, const std::string& text) { (void)std::fwrite(text.data(), 1, text.size(), where); }

/// Prints like fmt::print, with control characters as escapes. Never throws because of where it prints, as put().
template <class... Values>
void say(std::FILE* where, fmt::format_string<Values...> format, Values&&... values) {
    put(where, printable(fmt::format(format, std::forward<Values>(values)...)));
}

/// The same on stdout.
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
    say(stdout, format, std::forward<Values>(values)...);
}

}  // namespace feldspar
