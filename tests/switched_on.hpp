// Commented files to start from, with what they leave out put in.
#pragma once

#include <algorithm>
#include <functional>
#include <string>

namespace feldspar {

/// The text with every line "# key = value" and "# [table]" switched on.
/// @param stays_off  lines that remain comments; none unless given
inline std::string switched_on(const std::string& text, const std::function<bool(const std::string&)>& stays_off = {}) {
    std::string on;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        const bool off = line.starts_with("# [") || (line.starts_with("# ") && line.find(" = ") != std::string::npos &&
                                                     line.find(" = ") == line.find(' ', 2));
        on += (off && !(stays_off && stays_off(line)) ? line.substr(2) : line) + "\n";
        at = end + 1;
    }
    return on;
}

}  // namespace feldspar
